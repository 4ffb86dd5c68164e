#!/usr/bin/env bash
# tests/window_ends.sh [ROUNDS]: ends a window ROUNDS times (40) at random moments after a click, a second click and, every
# other time, an export, by INT, TERM, HUP and KILL in turn. What it saved by itself must be whole and hold the first
# click, what it exported must be whole; only KILL may leave part files, which the next window's export writes over.
# Prints counts; ends with 1 where one was wrong. SEED chooses other moments, BUILD another program.
set -uo pipefail
rounds=${1:-40}
root=$(cd "$(dirname "$0")/.." && pwd)
program=$(cd "${BUILD:-$root/build/release}" && pwd)/splatcut
source "$root/tests/virtual_screen.sh"
RANDOM=${SEED:-1}
cp "$root"/assets/sample/{sample.compressed.ply,cameras.json} "$work/"
start_screen 1280x800
export DISPLAY=$screen
state=$work/state/splatcut
appears() { for _ in $(seq 300); do xdotool search --name "$1" >/dev/null 2>&1 && return; sleep 0.1; done; return 1; }
is_whole() { "$program" cut --work "$1" -o "$work/again" --overwrite --quiet 2>>"$work/log"; }

wrong=0
declare -A ended offered exported left
for ((round = 0; round < rounds; ++round)); do
  signals=(TERM KILL HUP INT)
  signal=${signals[round % 4]} exports=$((round / 4 % 2))
  rm -rf "$state" "$work"/sample_*.ply*
  "$program" --width 1280 --height 800 "$work/sample.compressed.ply" >"$work/log" 2>&1 &
  pid=$!
  children+=($pid)
  appears sample || { echo "no window"; exit 1; }
  sleep 0.7
  xdotool mousemove 668 524 sleep 0.1 click 1
  appears '^\* sample' || { echo "round $round: the click was not taken"; exit 1; }
  clicked=$(date +%s%3N)
  (
    sleep 0.4
    xdotool mousemove 595 470 sleep 0.1 click 1
    [ $exports = 0 ] || xdotool sleep 0.3 key ctrl+e sleep 0.3 mousemove 1058 599 sleep 0.1 click 1
  ) 2>/dev/null &
  hands=$!
  longest_ms=3000
  [ $signal != KILL ] || longest_ms=9000  # what is not ended in order has saved its work two seconds after an edit
  sleep "$(awk "BEGIN {print $((exports * 1200 + RANDOM % longest_ms)) / 1000}")"
  kill -$signal $pid
  wait $pid 2>/dev/null
  code=$?
  wait $hands
  ended[$signal]=$((${ended[$signal]:-0} + 1))
  fault=
  [ $signal = KILL ] || [ $code = 0 ] || fault="exit code $code"
  work_file=$(ls "$state"/autosave*.json 2>/dev/null | head -n 1)
  if [ -n "$work_file" ]; then
    offered[$signal]=$((${offered[$signal]:-0} + 1))
    grep -q '"label": *"object"' "$work_file" || fault="the click is not in saved work"
    is_whole "$work_file" || fault="saved work cannot be read: $(tail -n 1 "$work/log")"
  elif [ $signal != KILL ]; then
    fault="$(($(date +%s%3N) - clicked)) ms after the click nothing is saved"
  fi
  for file in "$work"/sample_*.ply; do
    [ -f "$file" ] || continue
    exported[$signal]=$((${exported[$signal]:-0} + 1))
    "$program" info "$file" --quiet >/dev/null 2>>"$work/log" || fault="the exported file is not whole"
  done
  if [ -n "$(find "$work" -name '*.splatcut.part' -o -name '*.splatcut.new')" ]; then
    left[$signal]=$((${left[$signal]:-0} + 1))
    [ $signal = KILL ] || fault="something is left half written"
    find "$work" -name '*.splatcut.part' -delete
  fi
  [ -z "$fault" ] || { wrong=$((wrong + 1)); echo "round $round, $signal: $fault"; }
done
for signal in INT TERM HUP KILL; do
  printf '%-5s rounds %2d  work saved %2d  exported %2d  left over %d\n' $signal "${ended[$signal]:-0}" \
    "${offered[$signal]:-0}" "${exported[$signal]:-0}" "${left[$signal]:-0}"
done
[ $wrong = 0 ]
