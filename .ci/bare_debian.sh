#!/usr/bin/env bash
# Makes a bare Debian 12 root, copies the last commit into it and runs ./run.sh and ./test.sh there: what a newcomer
# meets. As root, from this machine's Debian mirror. The root goes when all is well; --keep: stays.
set -euo pipefail
cd "$(dirname "$0")/.."
keep=${1:-}
source .ci/bare_root.sh

make_root
git archive HEAD | tar -x -C "$bare/splatcut"
inside ./run.sh
[ -s "$bare/splatcut/cutout/object.ply" ] || stop "./run.sh cut nothing out."
inside ./test.sh
grep -E "tests passed|tests failed" "$log" | tail -n 1
