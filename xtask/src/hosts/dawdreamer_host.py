"""Plays MIDI files through a VST3 plugin in DawDreamer: PLUGIN RATE SECONDS [SONG.mid OUT.f32 ...]."""

import sys

import dawdreamer
import numpy

plugin, rate, seconds = sys.argv[1:4]
engine = dawdreamer.RenderEngine(int(rate), 512)
processor = engine.make_plugin_processor("low_action", plugin)
engine.load_graph([(processor, [])])
for song, output in zip(sys.argv[4::2], sys.argv[5::2]):
    processor.load_midi(song, clear_previous=True, beats=False, all_events=True)
    engine.render(float(seconds))
    numpy.ascontiguousarray(engine.get_audio().T.astype("<f4")).tofile(output)
