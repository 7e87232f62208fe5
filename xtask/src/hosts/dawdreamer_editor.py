"""Opens a VST3 plugin's editor in DawDreamer while it plays a chord, until it is ended: PLUGIN."""

import sys
import threading
import time

import dawdreamer

engine = dawdreamer.RenderEngine(48000, 512)
processor = engine.make_plugin_processor("low_action", sys.argv[1])
for key in (40, 47, 52, 56, 59, 64):
    processor.add_midi_note(key, 127, 0.01, 1000.0)
engine.load_graph([(processor, [])])


def play():
    while True:
        # Each time the chord is struck again.
        engine.render(0.1)
        time.sleep(0.05)


threading.Thread(target=play, daemon=True).start()
processor.open_editor()
