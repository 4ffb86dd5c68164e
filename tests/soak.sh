#!/usr/bin/env bash
# tests/soak.sh [STEPS [SECONDS]]: long sessions, as CSV. Without a window: STEPS (1000) random edits, cuts, undos and
# exports, then a tenth as many scenes opened, cut and closed. In a window on a virtual screen for SECONDS (300): clicks,
# strokes, turns, undo, isolation, with memory, open files, threads and the longest frames every ten seconds. BUILD chooses
# other programs.
set -uo pipefail
steps=${1:-1000} seconds=${2:-300}
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "${BUILD:-$root/build/release}" && pwd)
SPLATCUT_SOAK=$steps "$build/tests/studio_tests" --test-case='soak*' || exit 1

source "$root/tests/virtual_screen.sh"
cp "$root"/assets/sample/{sample.compressed.ply,cameras.json} "$work/"
start_screen 1280x800
export DISPLAY=$screen
"$build/splatcut" view "$work/sample.compressed.ply" --width 1280 --height 800 --frame-times >"$work/frames" 2>"$work/log" &
pid=$!
children+=($pid)
for _ in $(seq 300); do xdotool search --name sample >/dev/null 2>&1 && break; sleep 0.2; done
RANDOM=${SEED:-1}
any() { echo $(($1 + RANDOM % ($2 - $1))); }
frames_written() { wc -l <"$work/frames"; }
longest_frames() {  # of the seconds after line $1: all; while something was computed; of these without OpenGL
  awk -F, -v from="$1" 'NR > from && NR > 1 {
      own = $4 + $5 + $6 + $8
      if ($3 > all) all = $3
      if ($10 && $3 > busy) busy = $3
      if ($10 && own > without) without = own
    }
    END { printf "%.1f,%.1f,%.1f", all, busy, without }' "$work/frames"
}
echo "window,second,memory_mb,files,threads,actions,longest_frame_ms,longest_working_ms,longest_working_without_gl_ms"
seen=$(frames_written)
start=$SECONDS actions=0 next=0
while [ $((SECONDS - start)) -lt "$seconds" ]; do
  x=$(any 400 1000) y=$(any 200 650)
  case $((RANDOM % 8)) in
    0 | 1) xdotool key 1 mousemove "$x" "$y" sleep 0.1 click 1 ;;
    2) xdotool key 3 mousemove "$x" "$y" mousedown 1 mousemove $((x + 20)) $((y + 10)) mouseup 1 ;;
    3) xdotool mousemove "$x" "$y" mousedown 3 mousemove $((x + 90)) $((y + 20)) mouseup 3 ;;
    4) xdotool mousemove "$x" "$y" click 4 click 5 ;;
    5) xdotool key ctrl+z ;;
    6) xdotool key i ;;
    7) xdotool key ctrl+y ;;
  esac
  actions=$((actions + 1))
  kill -0 $pid 2>/dev/null || { echo "the window ended:"; cat "$work/log"; exit 1; }
  if [ $((SECONDS - start)) -ge $next ]; then
    echo "window,$((SECONDS - start)),$(awk '/VmRSS/ {printf "%.1f", $2 / 1024}' /proc/$pid/status),$(ls /proc/$pid/fd | wc -l),$(awk '/Threads/ {print $2}' /proc/$pid/status),$actions,$(longest_frames "$seen")"
    seen=$(frames_written)
    next=$((next + 10))
  fi
  sleep 0.3
done
