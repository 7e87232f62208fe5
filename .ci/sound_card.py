"""Takes in samples at the pace of a sound card, and keeps them in a file: 32 bits, two channels, 48 kHz.

sound_card.py FILE            what stands in for the card: reads until there is no more
sound_card.py --check FILE    fails unless silence, a strum and its ringing on are in it
"""

import array
import sys
import time

RATE = 48_000
FRAME = 8
# How far ahead of time it takes samples in, as the buffer of a card does, s.
AHEAD = 0.02


def play(path):
    begun, taken = time.monotonic(), 0
    with open(path, "wb", buffering=0) as file:
        while block := sys.stdin.buffer.read1(256 * FRAME):
            file.write(block)
            taken += len(block)
            time.sleep(max(0.0, taken / FRAME / RATE - AHEAD - (time.monotonic() - begun)))


def check(path):
    samples = array.array("f")
    with open(path, "rb") as file:
        data = file.read()
    samples.frombytes(data[: len(data) // FRAME * FRAME])
    left, right = samples[::2], samples[1::2]
    seconds = len(left) / RATE
    peak = max(map(abs, samples), default=0.0)
    first = next((at for at, pair in enumerate(zip(left, right)) if pair != (0.0, 0.0)), len(left))
    ringing = [max(map(abs, left[at : at + RATE // 20])) for at in range(first, len(left) - RATE // 20, RATE // 20)]
    print(f"{seconds:.1f} s, silent for {first / RATE:.1f} s, then {len(ringing) / 20:.1f} s of sound, peak {peak:.3f}")
    # A number that is none is equal to nothing, itself neither.
    if any(sample != sample for sample in samples) or not 0.01 < peak <= 1.0:
        sys.exit(f"{path}: the strum is not heard, or is no sound: peak {peak}")
    if first < RATE // 2 or len(ringing) < 20:
        sys.exit(f"{path}: no silence before the strum, or no second of ringing after it")
    if min(ringing[:20]) < 1e-4:
        sys.exit(f"{path}: the sound stops within the first second of the strum")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["--check", path]:
            check(path)
        case [path]:
            play(path)
        case _:
            sys.exit(__doc__)
