#!/usr/bin/env bash
# Opens the program in a real window on a virtual screen, clicks, scribbles, isolates, exports, quits; then computes
# the saved work again without a window.
# Usage: real_window_test.sh PROGRAM SAMPLE_FOLDER [SHOTS_FOLDER]   exit 77: skipped, with a sentence why.
set -euo pipefail
program=$1 sample=$2 shots=${3:-}
source "$(dirname "$0")/virtual_screen.sh"
[ -z "$shots" ] || mkdir -p "$shots"
fail() { echo "failed: $*"; cat "$work/program.log"; cat "$items"; exit 1; }

cp "$sample/sample.compressed.ply" "$sample/cameras.json" "$work/"
start_screen 1280x800
export DISPLAY=$screen SPLATCUT_ITEMS=$items

# A program that searches for leaks does so when its driver is unloaded, whose own tables then belong to nobody.
asan=$(ldd "$program" | awk '/libasan/ {print $3}')
driver=${asan:+$asan:libGLX_mesa.so.0:$(echo /usr/lib/*/dri/swrast_dri.so)}
env ${driver:+LD_PRELOAD="$driver"} "$program" --width 1280 --height 800 "$work/sample.compressed.ply" >"$work/program.log" 2>&1 &
pid=$!
children+=($pid)
autosave=$work/state/splatcut/autosave.splatcut.json
shot() { [ -z "$shots" ] || { sleep 1; import -window root "$shots/$1.png"; }; }
wait_for() {  # wait_for SECONDS WHAT COMMAND...
  local seconds=$1 what=$2; shift 2
  for _ in $(seq $((seconds * 5))); do
    "$@" >/dev/null 2>&1 && return
    kill -0 $pid 2>/dev/null || fail "the program ended while waiting for $what"
    sleep 0.2
  done
  fail "no $what after $seconds s"
}
click() { xdotool mousemove "$1" "$2" sleep 0.2 click "${3:-1}" sleep 0.2; }

wait_for 60 "window" xdotool search --name sample
sleep 1
shot 1_opened
wait_for 10 "settings, kept while it runs" grep -q sample "$work/config/splatcut/settings.json"
read -r x y <<<"$(pixel_at 670 490)"  # of the apple
click "$x" "$y"
wait_for 240 "cutout of the apple" grep -q '"cut_is_current": *true' "$autosave"
xdotool mousemove 1270 600 sleep 0.7  # beside the picture: hovering outlines what a click would change
shot 2_clicked
before=$(stat -c %Y.%s "$autosave")
xdotool key Escape key 3 mousemove $((x - 8)) $((y - 19)) mousedown 1 mousemove "$x" $((y - 9)) mousemove $((x + 8)) $((y + 6)) mouseup 1
# The newest object stands last; older steps of the history have cuts that are not current.
newest_is_cut() { grep -o '"cut_is_current": *[a-z]*' "$autosave" | tail -1 | grep -q true; }
changed() { [ "$(stat -c %Y.%s "$autosave")" != "$before" ] && newest_is_cut; }
wait_for 240 "new cutout after the stroke" changed
shot 3_scribbled
xdotool key i; shot 4_isolated
xdotool key ctrl+e sleep 1; shot 5_export
press() { local at; at=$(button_at "$1") && click $at; }
wait_for 10 "button Export" press '^Export$'
exported() { ls "$work"/sample_*.ply; }
wait_for 60 "exported file" exported
shot 6_exported
cp "$autosave" "$work/apple.splatcut.json"       # leaving the program for good removes it
xdotool key ctrl+q sleep 1; shot 7_quit
for _ in $(seq 60); do
  press '^Leave$' || true  # the dialog may not be there yet
  kill -0 $pid 2>/dev/null || break
  sleep 1
done
kill -0 $pid 2>/dev/null && fail "it does not quit"
wait $pid || fail "it ended with an error"
info=$("$program" info "$work"/sample_*.ply)
count=$(echo "$info" | awk '$1 == "gaussians" {print $2}')
echo "exported $count Gaussians"
[ "$count" -gt 2000 ] && [ "$count" -lt 20000 ] || fail "that is no apple"

# The command cuts what the window cut, to the byte: strokes from the file, nothing else of it.
labels_of() { grep -o '"cut": *\[[^]]*\]' "$1" | tr -d ' '; }
[ -n "$(labels_of "$work/apple.splatcut.json")" ] || fail "the saved work holds no labels"
sed 's/"cut": *\[[^]]*\]/"cut":null/' "$work/apple.splatcut.json" >"$work/strokes.splatcut.json"
[ -z "$(labels_of "$work/strokes.splatcut.json")" ] || fail "the labels were not taken out of the saved work"
"$program" cut --work "$work/strokes.splatcut.json" -o "$work/again" --quiet || fail "cut --work did not run"
cmp "$work"/sample_*.ply "$work"/again/*.ply || fail "cut --work gives another object than the window"
rows=$("$program" info "$work/sample.compressed.ply" | awk '$1 == "gaussians" {print $2}')
[ "$(stat -c %s "$work"/again/*.labels.u8)" -eq "$rows" ] || fail "the labels do not cover the file's $rows rows"
[ "$(tr -d '\000' <"$(echo "$work"/again/*.labels.u8)" | wc -c)" -eq "$count" ] || fail "labels and exported rows differ"
echo "cut --work: the same $count Gaussians, byte for byte"

# Ended by a signal a moment after a stroke: nothing is asked, nothing is lost, nothing is left half written.
"$program" --width 1280 --height 800 "$work/sample.compressed.ply" >"$work/program.log" 2>&1 &
pid=$!
children+=($pid)
wait_for 60 "window again" xdotool search --name sample
sleep 1
click "$x" "$y"
wait_for 60 "mark of unsaved work" xdotool search --name '^\* sample'
kill -TERM $pid
wait $pid || fail "a signal ended it with an error"
grep -q '"label": *"object"' "$autosave" || fail "the stroke before the signal is lost"
left=$(find "$work" -name '*.splatcut.part' -o -name '*.splatcut.new')
[ -z "$left" ] || fail "left behind: $left"
echo "SIGTERM: the stroke is in saved work"
