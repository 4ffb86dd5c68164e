#!/usr/bin/env bash
# Makes a bare Debian 12 root, copies the last commit into it and runs ./run.sh and ./test.sh there: what a newcomer
# meets. As root, from this machine's Debian mirror. The root goes when all is well; --keep: stays.
set -euo pipefail
cd "$(dirname "$0")/.."
keep=${1:-}
source .ci/bare_root.sh

make_root
git archive HEAD | tar -x -C "$bare/splatcut"
# Without a window first: nothing that the window is built with is there yet.
inside "root=\$PWD; source third_party/setup.sh; install_missing_packages apt-packages.txt"
inside "cmake --preset user -B build/no-window -DSPLATCUT_WINDOW=OFF && cmake --build build/no-window --target splatcut"
inside "build/no-window/splatcut cut assets/sample/sample.compressed.ply --cameras assets/sample/cameras.json --camera 0 --click 670,490 -o cut"
[ -s "$bare/splatcut/cut/object.ply" ] || stop "the splatcut without a window cut nothing out."
inside "build/no-window/splatcut render assets/sample/sample.compressed.ply -o cut/view.png && build/no-window/splatcut convert cut/object.ply -o cut/object.spz"
inside "! build/no-window/splatcut cut/object.ply 2>said && grep -q 'built without one' said"
inside "rm -r build cut said"
inside ./run.sh
[ -s "$bare/splatcut/cutout/object.ply" ] || stop "./run.sh cut nothing out."
inside ./test.sh
grep -E "tests passed|tests failed" "$log" | tail -n 1
