#!/usr/bin/env bash
# tests/fuzz/run.sh SECONDS [READER...]: builds the fuzzers (clang, third_party/apt-packages-gate.txt) and runs each for
# so many seconds from its corpus. What they find lies in build/fuzz/findings; ends with 1 where there is any.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:?how many seconds each}
shift
readers=("$@")
[ ${#readers[@]} -gt 0 ] || readers=(ply splat spz sog sog_text streamed_sog_text glb gltf lcc lcc2 rad ksplat json_cameras colmap_bin colmap_txt png picture cache seeds work suite
  words jobs result request)
at="the build"
# Ended by a signal or a command that failed, it must not look as if nothing had been found.
trap '[ "$at" = "the end" ] || echo "run.sh stopped in $at: not all readers were tried" >&2' EXIT
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target "${readers[@]/#/fuzz_}"
cd build/fuzz
mkdir -p findings
found=0
for reader in "${readers[@]}"; do
  at=$reader
  source=../../tests/fuzz
  mkdir -p "grown/$reader"
  case $reader in
    ply) dict=ply ;;
    json_cameras | seeds | result | request | work | suite | sog_text | streamed_sog_text | gltf | lcc | lcc2 | rad) dict=json ;;
    *) dict= ;;
  esac
  most=4096
  [ "$reader" != ksplat ] || most=8192 # a header takes 4096
  # Standard input may be a list that the caller reads.
  nice "tests/fuzz/fuzz_$reader" "grown/$reader" "$source/corpus/$reader" ${dict:+-dict=$source/$dict.dict} \
    -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=$most -print_final_stats=1 \
    -artifact_prefix="findings/$reader." </dev/null >"findings/$reader.log" 2>&1 ||
    { found=1; echo "$reader: FOUND, see build/fuzz/findings"; }
  echo "$reader: $(sed -n 's/^stat::number_of_executed_units: *//p' "findings/$reader.log") inputs"
done
at="the end"
exit $found
