#!/usr/bin/env bash
# tests/gl_stand_ins.sh PROGRAM SCENE: opens the window where OpenGL is too old, software, without a driver, without GLX,
# without EGL, and where there is no display. Each time a window comes, or one sentence and exit code 1.
# Prints the table of docs/reliability.md. Exit 77: skipped, with a sentence why.
set -uo pipefail
program=$1 scene=$2
source "$(dirname "$0")/virtual_screen.sh"
mkdir "$work/empty"

start_screen 1280x800
usual=DISPLAY=$screen
start_screen 1280x800 -extension GLX
without_glx=DISPLAY=$screen

wrong=0
try() { # WHAT window|sentence VARIABLES...
  local what=$1 wanted=$2 is=nothing code=- pid
  shift 2
  (exec env "$@" "$program" view "$scene" --width 800 --height 600 >"$work/log" 2>&1) &
  pid=$!
  children+=($pid)
  for _ in $(seq 300); do
    if ! kill -0 $pid 2>/dev/null; then
      wait $pid
      code=$?
      [ $code = 1 ] && [ "$(grep -c '^splatcut: ' "$work/log")" = 1 ] && is=sentence
      break
    fi
    if env "$@" timeout 5 xdotool search --name 'sample' >/dev/null 2>&1; then
      sleep 1  # and is drawn
      kill -0 $pid 2>/dev/null && is=window
      break
    fi
    sleep 0.2
  done
  kill $pid 2>/dev/null
  wait $pid 2>/dev/null
  echo "| $what | $is | $(grep '^splatcut: ' "$work/log" | head -1 | sed 's/^splatcut: //') |"
  [ $is = "$wanted" ] || { wrong=1; echo "wanted: $wanted, exit code $code"; cat "$work/log"; }
}

echo "| stand-in | ends with | said |"
echo "|---|---|---|"
try "no display" sentence A=
try "a display that is not there" sentence DISPLAY=:98765
try "software" window "$usual" LIBGL_ALWAYS_SOFTWARE=1
try "OpenGL 2.1" window "$usual" MESA_GL_VERSION_OVERRIDE=2.1
try "OpenGL 3.1" window "$usual" MESA_GL_VERSION_OVERRIDE=3.1
try "no driver" sentence "$usual" LIBGL_DRIVERS_PATH="$work/empty"
try "no GLX" window "$without_glx"
try "neither GLX nor EGL" sentence "$without_glx" __EGL_VENDOR_LIBRARY_DIRS="$work/empty"
exit $wrong
