#!/usr/bin/env bash
# tests/soak.sh [STEPS [SECONDS]]: long sessions, as CSV. Without a window: STEPS (1000) random edits, cuts, undos and
# exports, then a tenth as many scenes opened, cut and closed. In a window on a virtual screen for SECONDS (300): clicks,
# strokes, brush, turns, sizes, undo, isolation, new objects, with memory, open files, threads, seconds in which something
# was computed, and the longest frames every ten seconds. BUILD chooses other programs.
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
frames_since() {  # of the seconds after line $1: those in which something was computed, the longest frame of all, of those, and without OpenGL
  awk -F, -v from="$1" 'NR > from && NR > 1 {
      own = $4 + $5 + $6 + $8
      if ($3 > all) all = $3
      working += $10
      if ($10 && $3 > busy) busy = $3
      if ($10 && own > without) without = own
    }
    END { printf "%d,%.1f,%.1f,%.1f", working, all, busy, without }' "$work/frames"
}
echo "window,second,memory_mb,files,threads,actions,working_seconds,longest_frame_ms,longest_working_ms,longest_working_without_gl_ms"
seen=$(frames_written)
start=$SECONDS actions=0 next=0
while [ $((SECONDS - start)) -lt "$seconds" ]; do
  x=$(any 400 900) y=$(any 200 620)
  case $((RANDOM % 16)) in
    0 | 1 | 2 | 3) xdotool key 2 mousemove "$x" "$y" sleep 0.1 click 1 ;;
    4) xdotool key 2 mousemove "$x" "$y" sleep 0.1 click 3 ;;
    5) xdotool key 3 mousemove "$x" "$y" mousedown 1 mousemove $((x + 20)) $((y + 10)) mouseup 1 ;;
    6) xdotool key 4 mousemove "$x" "$y" mousedown 1 mousemove $((x + 30)) $((y + 10)) mouseup 1 ;;
    7) xdotool key 1 mousemove "$x" "$y" mousedown 1 mousemove $((x + 90)) $((y + 20)) mouseup 1 ;;
    8) xdotool mousemove "$x" "$y" click 4 click 5 ;;
    9) xdotool key ctrl+z ;;
    10) xdotool key ctrl+y ;;
    11) xdotool key i sleep 0.5 key i ;;
    12) xdotool key n ;;
    13) xdotool key equal ;;
    14) xdotool key Prior sleep 0.5 key Next ;;
    15) [ $((RANDOM % 4)) -gt 0 ] || xdotool key ctrl+n ;;
  esac
  # Back to a camera of the capture, or one ends far from everything; and to the beginning, or the history takes all memory.
  [ $((actions % 10)) -gt 0 ] || xdotool key n
  [ $((actions % 150)) -lt 149 ] || xdotool key --delay 50 --repeat 150 ctrl+z
  actions=$((actions + 1))
  kill -0 $pid 2>/dev/null || { echo "the window ended:"; cat "$work/log"; exit 1; }
  if [ $((SECONDS - start)) -ge $next ]; then
    echo "window,$((SECONDS - start)),$(awk '/VmRSS/ {printf "%.1f", $2 / 1024}' /proc/$pid/status),$(ls /proc/$pid/fd | wc -l),$(awk '/Threads/ {print $2}' /proc/$pid/status),$actions,$(frames_since "$seen")"
    seen=$(frames_written)
    next=$((next + 10))
  fi
  sleep 0.3
done
