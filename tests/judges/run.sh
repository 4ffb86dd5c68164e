#!/usr/bin/env bash
# run.sh SPLATCUT FOLDER [DEGREES]: the judges (judge.mjs) with the packages that .ci/judges has put into FOLDER. Without them the
# test is skipped (77), as nobody who uses the program needs node.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")
program=$1 folder=$2 degrees=${3:-0,1,2,3}
command -v node >/dev/null && [ -d "$folder/node_modules" ] ||
  { echo "Skipped: the readers of others are not here; .ci/judges installs them."; exit 77; }
cp "$here"/*.mjs "$folder"
# Its own package.json does not call it a module.
cp "$folder"/node_modules/@mkkellogg/gaussian-splats-3d/build/gaussian-splats-3d.module.js "$folder/gaussian-splats-3d.mjs"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
node "$folder/judge.mjs" "$program" "$scratch" "$degrees"
