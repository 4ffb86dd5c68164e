#!/usr/bin/env bash
# Measures CPU time and memory of `splatcut render` and of a `splatcut cut` with nothing prepared, against the size of the scene
# and of the object, and draws docs/scene_growth.svg. Scenes: a still life of 100,000 Gaussians so many times, in
# a square; still lifes of so many Gaussians. Needs gnuplot, python3, GNU time and 5 GB for scenes; takes some minutes.
#   bench/scene_growth_chart.sh
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
program=$root/build/release
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

still_life() {  # Gaussians -> $work/one, degree 0
  rm -rf "$work/one"
  "$program/splatcut-lab" --quiet make-scene still-life --gaussians "$1" --sh-degree 0 -o "$work/one" > "$work/log" 2>&1
}
in_a_square() {  # times -> $work/scene.ply
  python3 - "$work/one/still-life.ply" "$work/scene.ply" "$1" <<'PYTHON'
import array, math, sys
source, target, times = sys.argv[1], sys.argv[2], int(sys.argv[3])
with open(source, 'rb') as file:
    header = []
    while not header or header[-1] != b'end_header\n':
        header.append(file.readline())
    values = array.array('f', file.read())
names = [line.split()[2] for line in header if line.startswith(b'property float')]
columns = [slice(names.index(axis), None, len(names)) for axis in (b'x', b'z')]
places = [values[column] for column in columns]
width, depth = (1.1 * (max(p) - min(p)) for p in places)
side = math.ceil(math.sqrt(times))
with open(target, 'wb') as file:
    file.writelines(line.replace(b'%d' % len(places[0]), b'%d' % (len(places[0]) * times)) for line in header)
    for i in range(times):
        for column, place, step in zip(columns, places, (i % side * width, i // side * depth)):
            values[column] = array.array('f', (v + step for v in place))
        values.tofile(file)
PYTHON
}
measure() {  # command -> "CPU seconds, peak MiB"
  rm -rf "$work/cache" "$work/out"
  XDG_CACHE_HOME=$work/cache /usr/bin/time -f '%U %S %M' -o "$work/time" "$@" > "$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  awk 'END { print $1 + $2, $3 / 1024 }' "$work/time"
}
view=(--cameras "$work/one/cameras.json" --camera 0)
cut() { measure "$program/splatcut" --quiet cut "$1" "${view[@]}" --click "$2" -o "$work/out"; }

still_life 100000
click=$(python3 -c "
import json
seeds = json.load(open('$work/one/seeds.json'))['objects'][0]['clicks'][0]
print(f\"{seeds['x']},{seeds['y']}\")")
echo "# Gaussians of the scene, render: CPU s, peak MiB, cut: CPU s, peak MiB" | tee "$work/scenes"
for times in 1 2 5 10 20 50 120; do
  in_a_square "$times"
  drawn=$(measure "$program/splatcut" --quiet render "$work/scene.ply" "${view[@]}" -o "$work/out.png" --overwrite)
  echo "$((100000 * times)) $drawn $(cut "$work/scene.ply" "$click")" | tee -a "$work/scenes"
done
rm "$work/scene.ply"
echo "# Gaussians of the object, cut: CPU s, peak MiB, Gaussians of the still life" | tee "$work/objects"
for gaussians in 50000 100000 200000 500000 1000000 2000000 5000000; do
  still_life "$gaussians"
  cost=$(cut "$work/one/still-life.ply" "$click")
  object=$(python3 -c "import json; print(json.load(open('$work/out/report.json'))['object']['gaussians'])")
  echo "$object $cost $gaussians" | tee -a "$work/objects"
done
gnuplot <<PLOT
set terminal svg size 1000,760 font "sans,13" background "white"
set output "$root/docs/scene_growth.svg"
set multiplot layout 2,2
set logscale xy
set grid
set key top left Left reverse
set xlabel "Gaussians of the scene (still lifes of 100,000 in a square)"
set ylabel "CPU time (s)"
plot "$work/scenes" u 1:2 w lp title "render", "" u 1:4 w lp title "cut, nothing prepared"
set xlabel "Gaussians of the object (still life of .05 to 5 M)"
plot "$work/objects" u 1:2 w lp lt 2 title "cut, nothing prepared"
set xlabel "Gaussians of the scene (still lifes of 100,000 in a square)"
set ylabel "peak memory (MiB), with the file"
plot "$work/scenes" u 1:3 w lp title "render", "" u 1:5 w lp title "cut, nothing prepared"
set xlabel "Gaussians of the object (still life of .05 to 5 M)"
plot "$work/objects" u 1:3 w lp lt 2 title "cut, nothing prepared"
PLOT
