"""Plays MIDI files through a VST3 plugin in pedalboard: PLUGIN RATE SECONDS [SONG.mid OUT.f32 ...]."""

import sys

import mido
import numpy
import pedalboard

plugin, rate, seconds = sys.argv[1:4]
instrument = pedalboard.load_plugin(plugin)
for song, output in zip(sys.argv[4::2], sys.argv[5::2]):
    messages, now = [], 0.0
    for message in mido.MidiFile(song):
        now += message.time
        if not message.is_meta:
            messages.append((message.bytes(), now))
    sound = instrument(
        messages, duration=float(seconds), sample_rate=float(rate), num_channels=2, buffer_size=512, reset=True
    )
    numpy.ascontiguousarray(sound.T.astype("<f4")).tofile(output)
