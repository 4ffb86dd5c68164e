#!/usr/bin/env bash
# tests/fail_at_each_call.sh [COMMAND [STRIDE [CALL]]]: every fault of tests/app/cli/injected_faults_test.cpp at every call, or
# every STRIDE-th, one run a call, for all its commands or one ("cut", "convert to .spz"...), of all calls or one ("write").
# Prints the table of docs/reliability.md; ends with 1 where one run was wrong. BUILD chooses other programs.
set -euo pipefail
build=$(cd "${BUILD:-$(dirname "$0")/../build/release}" && pwd)
[ -z "${1:-}" ] || export SPLATCUT_FAULTS_OF=$1
[ -z "${3:-}" ] || export SPLATCUT_FAULT_CALL=$3
SPLATCUT_EVERY_FAULT=${2:-1} "$build/tests/slow_tests" --test-case='injected faults*'
