"""Fails unless both bundles are there, their libraries offer the formats' entry points and notices are beside them."""

import ctypes
import pathlib
import platform
import sys

folder = pathlib.Path(sys.argv[1])
notices = folder / "THIRD-PARTY.txt"
if not notices.is_file() or "SIL OPEN FONT LICENSE" not in notices.read_text(encoding="utf-8"):
    sys.exit(f"{notices} is missing, or has not all licences")
# After the list of libraries each text stands under the names of those that come with it.
listed, *texts = notices.read_text(encoding="utf-8").split("=" * 80)
libraries = [line.split(": ")[0] for line in listed.splitlines()[2:] if line]
named = {name for text in texts for name in text.strip().split(":\n")[0].split(", ")}
missing = [name for name in libraries if name not in named]
if missing or len(libraries) < 100:
    sys.exit(f"{notices} names {len(libraries)} libraries; without a text: {', '.join(missing) or 'none'}")
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
