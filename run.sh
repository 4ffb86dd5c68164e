#!/usr/bin/env bash
# Installs what is missing, builds, and opens SCENE (or the sample) in the window. Without a display it cuts the
# sample's apple, or draws SCENE, into files.
set -euo pipefail
root=$(cd "$(dirname "$0")" && pwd)
source "$root/third_party/setup.sh"
install_missing_packages apt-packages.txt apt-packages-window.txt
build_preset user splatcut
program="$root/build/release/splatcut"
sample="$root/assets/sample"
if no_window=$("$program" view --check 2>&1); then
  exec "$program" view "${1:-$sample/sample.compressed.ply}"
fi
echo "$no_window"
if [ $# -gt 0 ]; then
  picture="$PWD/$(basename "$1").png"
  "$program" info "$1"
  "$program" render "$1" -o "$picture" --overwrite
  echo "Look at $picture, then: $program cut $1 --click X,Y -o cutout"
else
  "$program" cut "$sample/sample.compressed.ply" --cameras "$sample/cameras.json" --camera 0 \
    --click 670,490 -o "$PWD/cutout" --overwrite
  echo "Look at $PWD/cutout/tint.png and object.png; object.ply opens in any splat viewer."
fi
