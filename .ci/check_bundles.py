"""Fails unless both bundles are there, their libraries offer the formats' entry points and notices are beside them."""

import ctypes
import pathlib
import platform
import sys

folder = pathlib.Path(sys.argv[1])
notices = folder / "THIRD-PARTY.txt"
if not notices.is_file() or "SIL OPEN FONT LICENSE" not in notices.read_text(encoding="utf-8"):
    sys.exit(f"{notices} is missing, or has not all licences")
# Where the two formats want the library, on Linux; elsewhere only the bundles' presence is checked.
ENTRIES = {
    "Low Action.clap": (".", "clap_entry"),
    "Low Action.vst3": (f"Contents/{platform.machine()}-linux/Low Action.so", "GetPluginFactory"),
}
for name, (inside, symbol) in ENTRIES.items():
    bundle = folder / name
    if not bundle.exists():
        sys.exit(f"{bundle} is missing")
    if sys.platform != "linux":
        continue
    library = (bundle / inside).resolve()
    if not library.is_file():
        sys.exit(f"{library} is missing")
    if not hasattr(ctypes.CDLL(str(library)), symbol):
        sys.exit(f"{library} does not export {symbol}")
    print(f"{bundle}: {library.stat().st_size / 2**20:.1f} MiB, exports {symbol}")
