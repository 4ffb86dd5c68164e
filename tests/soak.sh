#!/usr/bin/env bash
# tests/soak.sh [STEPS [SECONDS]]: long sessions, as CSV. Without a window: STEPS (1000) random edits, cuts, undos and
# exports, then a tenth as many scenes opened, cut and closed. In a window on a virtual screen for SECONDS (300): clicks,
# strokes, turns, undo, isolation, with memory, open files and threads every ten seconds. BUILD chooses other programs.
set -uo pipefail
steps=${1:-1000} seconds=${2:-300}
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "${BUILD:-$root/build/release}" && pwd)
SPLATCUT_SOAK=$steps "$build/tests/studio_tests" --test-case='soak*' || exit 1

work=$(mktemp -d)
children=()
cleanup() { for pid in "${children[@]}"; do kill "$pid" 2>/dev/null; done; rm -rf "$work"; }
trap cleanup EXIT
cp "$root"/assets/sample/{sample.compressed.ply,cameras.json} "$work/"
export XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/cache
unset WAYLAND_DISPLAY
Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp -noreset 3>"$work/display" 2>/dev/null &
children+=($!)
for _ in $(seq 300); do [ -s "$work/display" ] && break; sleep 0.1; done
export DISPLAY=:$(cat "$work/display")
"$build/splatcut" "$work/sample.compressed.ply" --width 1280 --height 800 >"$work/log" 2>&1 &
pid=$!
children+=($pid)
for _ in $(seq 300); do xdotool search --name sample >/dev/null 2>&1 && break; sleep 0.2; done
RANDOM=${SEED:-1}
any() { echo $(($1 + RANDOM % ($2 - $1))); }
echo "window,second,memory_mb,files,threads,actions"
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
    echo "window,$((SECONDS - start)),$(awk '/VmRSS/ {printf "%.1f", $2 / 1024}' /proc/$pid/status),$(ls /proc/$pid/fd | wc -l),$(awk '/Threads/ {print $2}' /proc/$pid/status),$actions"
    next=$((next + 10))
  fi
  sleep 0.3
done
