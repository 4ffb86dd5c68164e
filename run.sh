#!/usr/bin/env bash
# Installs what is missing, builds, and cuts the sample's apple (or shows SCENE).
set -euo pipefail
root=$(cd "$(dirname "$0")" && pwd)
source "$root/third_party/setup.sh"
install_missing_packages
build_release
program="$root/build/release/splatcut"
echo "There is no window yet in this version: splatcut works headless."
if [ $# -gt 0 ]; then
  picture="$PWD/$(basename "$1").png"
  "$program" info "$1"
  "$program" render "$1" -o "$picture" --overwrite
  echo "Look at $picture, then: $program cut $1 --click X,Y -o cutout"
else
  "$program" cut "$root/assets/sample/sample.compressed.ply" --cameras "$root/assets/sample/cameras.json" --camera 0 \
    --click 670,490 -o "$PWD/cutout" --overwrite
  echo "Look at $PWD/cutout/tint.png and object.png; object.ply opens in any splat viewer."
fi
