#!/usr/bin/env bash
# Measures the cut on still lifes of growing size and draws docs/cut_growth.svg. Needs gnuplot; takes some minutes.
#   bench/growth_chart.sh [RESULTS.json]    results of an earlier run: --benchmark_out=RESULTS.json --benchmark_out_format=json
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
results=${1:-$work/results.json}
if [ $# -eq 0 ]; then
  "$root/build/release/bench/splatcut_bench" --benchmark_min_time=0.2 --benchmark_out="$results" --benchmark_out_format=json \
    --benchmark_filter='^(cut_cold|cut_in_place|cut_next_view|boost_boykov_kolmogorov|opencv_gcgraph)/still_life'
fi
series() {  # name of the benchmark -> lines of "thousand nodes, ms"
  awk -F'[":,/ ]+' -v name="$1" '
    $2 == "name" { wanted = $3 == name && $4 ~ /^still_life_[0-9]+k$/; k = $4; gsub(/[^0-9]/, "", k) }
    $2 == "real_time" && wanted { print k, $3 }' "$results" | sort -n
}
for name in cut_cold cut_in_place cut_next_view boost_boykov_kolmogorov opencv_gcgraph; do series "$name" > "$work/$name"; done
gnuplot <<PLOT
set terminal svg size 760,580 font "sans,13" background "white"
set output "$root/docs/cut_growth.svg"
set logscale xy
set xlabel "Gaussians (thousand)"
set ylabel "CPU time (ms)"
set key below vertical maxrows 5 Left reverse
set xtics (200, 500, 1000, 2000, 5000)
set grid
set xrange [180:5600]
plot "$work/boost_boykov_kolmogorov" w lp title "Boost boykov\\\\_kolmogorov, building included", \
     "$work/opencv_gcgraph" w lp title "OpenCV GCGraph, building included", \
     "$work/cut_cold" w lp lw 2 title "cold, building included", \
     "$work/cut_in_place" w lp lw 2 title "sub-graph, on a solver that stands ready", \
     "$work/cut_next_view" w lp lw 2 lc rgb "#c05000" title "warm, after one more view"
PLOT
