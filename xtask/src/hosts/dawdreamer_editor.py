"""Opens a VST3 plugin's editor in DawDreamer while it plays a chord, and once more when it is closed: PLUGIN."""

import ctypes
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


class XError(ctypes.Structure):
    """What Xlib tells of an error."""

    _fields_ = [
        ("type", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("resource", ctypes.c_ulong),
        ("serial", ctypes.c_ulong),
        ("error", ctypes.c_ubyte),
        ("request", ctypes.c_ubyte),
    ]


BAD_WINDOW, QUERY_TREE = 3, 15
Handler = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.POINTER(XError))


# JUCE asks for the parents of a window that is being closed, which may be gone by then. In its own applications it
# passes over what X says to that, but here the program would end.
@Handler
def pass_over(display, error):
    known = (error.contents.error, error.contents.request) == (BAD_WINDOW, QUERY_TREE)
    return 0 if known else usual(display, error)


x11 = ctypes.CDLL("libX11.so.6")
x11.XSetErrorHandler.restype = Handler
usual = x11.XSetErrorHandler(pass_over)

threading.Thread(target=play, daemon=True).start()
# Each returns when the window is closed.
processor.open_editor()
processor.open_editor()
