#!/usr/bin/env bash
# Drags an exported file out of one window into another program's, which opens it: a second one of this program.
# Usage: drag_out_test.sh PROGRAM SAMPLE_FOLDER [SHOTS_FOLDER]   exit 77: skipped, with a sentence why.
set -euo pipefail
program=$1 sample=$2 shots=${3:-}
source "$(dirname "$0")/virtual_screen.sh"
[ -z "$shots" ] || mkdir -p "$shots"
fail() { echo "failed: $*"; cat "$work"/*.log; exit 1; }

mkdir "$work/a b" "$work/cache"  # a name that must be encoded on its way
cp "$sample/sample.compressed.ply" "$sample/cameras.json" "$work/a b/"
start_screen 2100x800
export DISPLAY=$screen
window() {  # window NAME WIDTH [SCENE]: of a program with its own folders
  SPLATCUT_ITEMS=$items.$1 XDG_CONFIG_HOME=$work/$1/config XDG_STATE_HOME=$work/$1/state XDG_CACHE_HOME=$work/cache \
    "$program" view --width "$2" --height 800 ${3:+"$3"} >"$work/$1.log" 2>&1 &
  children+=($!)
}
shot() { [ -z "$shots" ] || import -window root "$shots/$1.png"; }
wait_for() {  # wait_for SECONDS WHAT COMMAND...
  local seconds=$1 what=$2; shift 2
  for _ in $(seq $((seconds * 5))); do
    "$@" >/dev/null 2>&1 && return
    sleep 0.2
  done
  shot failed
  fail "no $what after $seconds s"
}

window taker 800
wait_for 60 "second window" xdotool search --name '^splatcut$'
xdotool windowmove "$(xdotool search --name '^splatcut$' | tail -1)" 1290 0
window giver 1280 "$work/a b/sample.compressed.ply"
wait_for 60 "window with the scene" xdotool search --name 'sample.compressed.ply - splatcut'
xdotool windowmove "$(xdotool search --name 'sample.compressed.ply - splatcut' | tail -1)" 0 0 sleep 0.5
xdotool mousemove 600 300 sleep 0.3 key ctrl+e sleep 1.5 key Return
exported() { ls "$work/a b/sample_scene.ply"; }
wait_for 60 "exported file" exported
sleep 1; shot 1_exported
opened() { xdotool search --name 'sample_scene.ply - splatcut'; }
items=$items.giver
wait_for 10 "row of the exported file" button_at 'sample_scene\\.ply'
read -r x y <<<"$(button_at 'sample_scene\\.ply')"
# The row under Objects, which must see the press before the pointer leaves it: slower where frames are slow.
for pause in 0.5 1 2 4; do
  drag=(mousemove "$x" "$y" sleep $pause mousedown 1 sleep $pause mousemove $((x + 20)) "$y" sleep $pause)
  for beyond in 1150 1300 1450 1560; do drag+=(mousemove "$beyond" 300 sleep $pause); done
  xdotool "${drag[@]}"
  shot 2_dragged
  xdotool mouseup 1
  for _ in $(seq 50); do opened >/dev/null 2>&1 && break 2; sleep 0.2; done
done
wait_for 60 "scene in the second window" opened
sleep 1; shot 3_opened
kill -0 "${children[1]}" && kill -0 "${children[2]}" || fail "a program ended"
echo "passed"
