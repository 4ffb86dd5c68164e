#!/usr/bin/env bash
# Installs what is missing, builds, runs the tests without a display. --slow: those of the slow tier, too.
set -euo pipefail
root=$(cd "$(dirname "$0")" && pwd)
source "$root/third_party/setup.sh"
install_missing_packages apt-packages.txt apt-packages-window.txt apt-packages-tests.txt
build_preset release
which=(-LE slow)
[ "${1:-}" != --slow ] || which=()
cd "$root" && ctest --preset release -j "$(nproc)" "${which[@]}"
