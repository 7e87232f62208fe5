"""Fails if a file of the repository names a place that exists only on somebody's machine."""

import re
import subprocess
import sys

# Home folders of Linux, macOS and Windows, and the work folders that build machines use. The
# quantified groups keep these patterns from matching their own text.
PLACES = re.compile(rb"(?<![\w.~-])/(?:root|home|work|Users|mnt|builds?)/[\w.]|[A-Za-z]:\\+Users\\")

try:
    files = subprocess.run(["git", "ls-files", "-z"], check=True, capture_output=True).stdout
except FileNotFoundError:
    sys.exit("check_paths: git is missing")
except subprocess.CalledProcessError as error:
    # Outside a repository, or in one that is somebody else's. What can be done about it are further lines.
    said = error.stderr.decode(errors="replace").strip().splitlines()
    sys.exit(f"check_paths: git cannot list the files: {said[0] if said else error}")
bad = 0
for name in filter(None, files.split(b"\0")):
    try:
        with open(name, "rb") as file:
            lines = file.read().splitlines()
    except FileNotFoundError:
        continue  # deleted in the work tree, not yet in the index
    for number, line in enumerate(lines, 1):
        if b"\0" not in line and PLACES.search(line):
            print(f"{name.decode()}:{number}: {line.decode(errors='replace').strip()}", file=sys.stderr)
            bad += 1
if bad:
    sys.exit(f"{bad} lines name a path of one machine")
