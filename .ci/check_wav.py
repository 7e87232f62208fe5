"""Fails unless a file is a stereo PCM WAV with a healthy signal in it.

Reads the RIFF chunks itself: the standard `wave` module of Python 3.11 refuses the extensible header
that 24-bit files carry.
"""

import struct
import sys


def main(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != b"RIFF" or data[8:12] != b"WAVE":
        sys.exit(f"{path}: not a RIFF WAVE file")
    if struct.unpack_from("<I", data, 4)[0] + 8 != len(data):
        sys.exit(f"{path}: the header's size is not the file's")
    chunks = {}
    at = 12
    while at + 8 <= len(data):
        name, size = struct.unpack_from("<4sI", data, at)
        chunks[name] = data[at + 8 : at + 8 + size]
        at += 8 + size + size % 2
    tag, channels, rate, _, align, bits = struct.unpack_from("<HHIIHH", chunks[b"fmt "])
    if tag == 0xFFFE:
        tag = struct.unpack_from("<H", chunks[b"fmt "], 24)[0]
    if (tag, channels, rate, bits, align) != (1, 2, 48000, 24, 6):
        sys.exit(f"{path}: not 24-bit stereo PCM at 48 kHz: {tag=} {channels=} {rate=} {bits=} {align=}")

    body = chunks[b"data"]
    frames = len(body) // align
    if frames < rate:
        sys.exit(f"{path}: only {frames / rate:.2f} s long")
    samples = [int.from_bytes(body[i : i + 3], "little", signed=True) / 2**23 for i in range(0, frames * align, 3)]
    for side in range(2):
        channel = samples[side::2]
        peak = max(map(abs, channel))
        mean = sum(channel) / frames
        rms = (sum(x * x for x in channel) / frames) ** 0.5
        print(f"channel {side}: {frames / rate:.2f} s, peak {peak:.4f}, rms {rms:.4f}, mean {mean:.1e}")
        if peak >= 1.0 - 2**-23:
            sys.exit(f"{path}: channel {side} clips")
        if peak < 0.05 or rms < 0.002:
            sys.exit(f"{path}: channel {side} is all but silent")
        if abs(mean) > 1e-4:
            sys.exit(f"{path}: channel {side} has a constant offset")


main(sys.argv[1])
