"""Fails unless both bundles are there, their libraries offer the formats' entry points and notices are beside them."""

import ctypes
import pathlib
import platform
import sys

folder = pathlib.Path(sys.argv[1])
notices = folder / "THIRD-PARTY.txt"
# Of the fonts, of Rust's own library and of the plugin itself.
HELD = ["SIL OPEN FONT LICENSE", "Source Foundry Authors", "John Slegers", "The Rust Project Developers", "Low Action:\n"]
if not notices.is_file():
    sys.exit(f"{notices} is missing")
absent = [words for words in HELD if words not in notices.read_text(encoding="utf-8")]
if absent:
    sys.exit(f"{notices} has not all licences: {', '.join(map(str.strip, absent))}")
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
