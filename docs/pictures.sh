#!/usr/bin/env bash
# docs/pictures.sh [BUILD]: draws the pictures of README.md again, by the program: the sample, its apple after one click, the
# apple alone, and turning as an animation (img2webp, of Debian's package webp). docs/window.png is the picture
# 2_clicked.png of `tests/real_window_test.sh BUILD/splatcut assets/sample SHOTS`.
set -euo pipefail
cd "$(dirname "$0")/.."
splatcut=$PWD/${1:-build/release}/splatcut
sample=assets/sample/sample.compressed.ply
view=(--cameras assets/sample/cameras.json --camera 0 --size 504x378)
frames=$(mktemp -d)
trap 'rm -r "$frames"' EXIT

"$splatcut" render $sample "${view[@]}" -o "$frames/scene.png" --quiet
"$splatcut" cut $sample "${view[@]}" --click 335,245 -o "$frames/cut" --quiet
cp "$frames/cut/tint.png" docs/sample_tint.png
cp "$frames/cut/object.png" docs/sample_object.png
"$splatcut" render "$frames/cut/object.ply" "${view[@]}" --background 0.9,0.9,0.88 -o "$frames/alone.png" --quiet

# Once around the apple's middle, at the height of camera 0.
turn=()
for i in $(seq 0 29); do
  at=$(awk -v i="$i" 'BEGIN {a = 6.283185 * i / 30; printf "%f,-0.45,%f", 0.4 + 0.9 * sin(a), -0.48 - 0.9 * cos(a)}')
  "$splatcut" render "$frames/cut/object.ply" --camera-pos "$at" --camera-target 0.4,-0.15,-0.48 --camera-up 0,-1,0 --camera-fov 40 \
    --size 504x378 --background 0.9,0.9,0.88 -o "$frames/turn_$i.png" --quiet
  turn+=(-d 80 "$frames/turn_$i.png")
done
img2webp -loop 0 -lossy -q 80 -d 1200 "$frames/scene.png" -d 1500 "$frames/cut/tint.png" -d 1000 "$frames/alone.png" "${turn[@]}" -o docs/turn.webp
