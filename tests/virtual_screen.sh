# Sourced by the tests of real windows: $work, a folder of their own, with the program's own folders in it; $children,
# processes that end with the script; start_screen. Exit 77 where a tool is missing: skipped, with a sentence why.
for tool in Xvfb xdotool; do
  command -v $tool >/dev/null || { echo "skipped: $tool is not installed (apt install xvfb xdotool)"; exit 77; }
done
work=$(mktemp -d)
children=()
end_children() {
  local pid
  for pid in "${children[@]}"; do kill "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap end_children EXIT
export XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/cache
unset WAYLAND_DISPLAY DISPLAY

start_screen() {  # start_screen WIDTHxHEIGHT [OPTIONS OF XVFB...]: a virtual screen, $screen is its DISPLAY
  local number=$work/screen_${#children[@]}
  Xvfb -displayfd 3 -screen 0 "$1x24" -nolisten tcp -noreset "${@:2}" 3>"$number" 2>/dev/null &
  children+=($!)
  for _ in $(seq 300); do [ -s "$number" ] && break; sleep 0.1; done
  [ -s "$number" ] || { echo "skipped: Xvfb does not start here"; exit 77; }
  screen=:$(cat "$number")
}

# Where things lie in a window that runs with SPLATCUT_ITEMS=$items, at the screen's corner: the middle of a button, and a
# pixel of the sample's camera 0 (1008x756) while the view stands there.
items=$work/items
button_at() {  # button_at REGEX; fails where there is none
  awk -v name="$1" '{x = int(($1 + $3) / 2); y = int(($2 + $4) / 2); $1 = $2 = $3 = $4 = ""; sub(/^ */, "")}
    $0 ~ name {print x, y; found = 1; exit}
    END {exit !found}' "$items"
}
pixel_at() {
  awk -v x="$1" -v y="$2" '$5 == "picture" {
    scale = ($4 - $2) / 756
    print int(($1 + $3) / 2 + scale * (x - 504)), int(($2 + $4) / 2 + scale * (y - 378)) }' "$items"
}
