#!/usr/bin/env bash
# Installs what is missing, builds, runs every test without a display.
set -euo pipefail
root=$(cd "$(dirname "$0")" && pwd)
source "$root/third_party/setup.sh"
install_missing_packages apt-packages.txt
build_release
cd "$root" && ctest --preset release -j "$(nproc)"
