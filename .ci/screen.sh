# For scripts that look at windows, to be sourced: a screen that nobody sees, of the size that is given, and how to look at
# it. Needs Xvfb, xdotool and ImageMagick, and an OpenGL driver, if only one of software. What is started here or in
# `$started` is ended with the script; pictures go to `$folder`.

for tool in Xvfb xdotool import convert compare; do
    command -v "$tool" >/dev/null || { echo "$0: $tool is missing" >&2; exit 1; }
done
mkdir -p "$folder"
scratch="$(mktemp -d)"
started=
trap 'kill $started 2>/dev/null || true; rm -rf "$scratch"' EXIT

Xvfb -displayfd 3 -screen 0 "${1}x24" -nolisten tcp 3>"$scratch/display" 2>"$folder/xvfb.log" &
started=$!
for _ in $(seq 100); do
    [ -s "$scratch/display" ] && break
    kill -0 "$started" 2>/dev/null || break
    sleep 0.1
done
[ -s "$scratch/display" ] || { cat "$folder/xvfb.log" >&2; echo "$0: Xvfb does not start" >&2; exit 1; }
DISPLAY=":$(cat "$scratch/display")"
# What programs keep of their windows is not to go among the user's own data.
XDG_DATA_HOME="$scratch"
export DISPLAY XDG_DATA_HOME LIBGL_ALWAYS_SOFTWARE=1

# Of the meter, below full scale and at it, and of the strings, as the theme has them.
sound='#7fb28a' clipped='#e86a4f' strings='#e6e4de'

fail() { echo "$0: $*" >&2; exit 1; }
# The window of that title, for which it waits half a minute while a process lives; nothing if none comes.
find_window() {
    for _ in $(seq 150); do
        xdotool search --name "^$1\$" 2>/dev/null | head -n 1 | grep . && return
        kill -0 "$2" 2>/dev/null || break
        sleep 0.2
    done
    true
}
capture() { import -window "$window" "$folder/$1.png"; }
# A number as ImageMagick writes it, which may be 1.2e+06, as a whole one; -1 for what is none.
whole() { awk 'NR == 1 { number = $1 } END { printf "%.0f\n", number ~ /^[0-9.]+(e[+-]?[0-9]+)?$/ ? number : -1 }'; }
# How many pixels of a picture have a colour.
count() { convert "$folder/$1.png" -fuzz 4% -fill black +opaque "$2" -fill white -opaque "$2" -format '%[fx:int(mean*w*h)]' info: | whole; }
# How many pixels of the meter in a picture are lit. It is in the corner at the top right; elsewhere the same colours mean other things.
heard() {
    convert "$folder/$1.png" -gravity NorthEast -crop 184x48+0+0 +repage "$folder/$1_meter.png"
    echo $(($(count "$1_meter" "$sound") + $(count "$1_meter" "$clipped")))
}
# How many pixels of two pictures differ; -1 if their sizes do.
differing() { compare -metric AE -fuzz 4% "$folder/$1.png" "$folder/$2.png" null: 2>&1 | whole || true; }
# Whether fewer pixels differ than so many.
below() { [ "$1" -ge 0 ] && [ "$1" -lt "$2" ]; }
# Waits half a minute for a condition. It need not come: what was seen last is looked at afterwards.
wait_for() {
    for _ in $(seq 150); do "$@" && return; sleep 0.2; done
    true
}
# Whether the strings are drawn in a picture that is taken now.
draws() { capture "$1" && [ "$(count "$1" "$strings")" -gt 500 ]; }
# Whether the window has a size.
has_size() { [ "$(size)" = "WIDTH=$1 HEIGHT=$2 " ]; }
size() { xdotool getwindowgeometry --shell "$window" | grep -E 'WIDTH|HEIGHT' | tr '\n' ' '; }
# Moves the mouse to so many thousandths of a window that is `$WIDTH` by `$HEIGHT`.
at() { xdotool mousemove --window "$window" $((WIDTH * $1 / 1000)) $((HEIGHT * $2 / 1000)); }
# Strums the editor's strings: across all of them beyond the board, in a tenth of a second or so, and back.
strum() {
    at 860 80
    at 860 100
    xdotool mousedown 1
    for y in $(seq 100 12 450) $(seq 450 -12 100); do at 860 "$y"; sleep 0.01; done
    xdotool mouseup 1
}
# Ends a program as Ctrl+C in its terminal does, within ten seconds. It has its log at `$folder/instrument.log`.
interrupt() {
    kill -INT "$1"
    for _ in $(seq 100); do kill -0 "$1" 2>/dev/null || break; sleep 0.1; done
    kill -0 "$1" 2>/dev/null && fail "Ctrl+C does not end it"
    wait "$1" || { cat "$folder/instrument.log" >&2; fail "it ended with an error"; }
}
