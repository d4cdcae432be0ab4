#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# usage: ./test.sh [--all]
# Installs what the tests need, builds, and runs them. --all adds those that take long: the README's two
# commands in a fresh Debian root, longer simulated worlds, the ROS node (with its packages), and a minute of fuzzing for each parser.
# Captures are looked for in GLINT_DATA_DIR (default ../shared/data); without them their tests skip,
# or fail where CI=true.
set -euo pipefail
cd "$(dirname "$0")"

step="starting"
trap 'status=$?; [ $status -eq 0 ] || echo "test.sh: failed while $step (see above)" >&2' EXIT
say() {
  step="$1"
  echo "test.sh: $1"
}

labels=(-LE long)
all=false
packages=test
case "${1:-}" in
  "") ;;
  --all) labels=(); all=true; packages=all ;;
  *) echo "usage: ./test.sh [--all]" >&2; exit 2 ;;
esac

say "installing the packages that the tests need"
.ci/install-packages $packages

say "building"
preset=release
[ "${CI:-}" = true ] && preset=ci
cmake --preset $preset -DGLINT_BUILD_TESTS=ON >/dev/null
cmake --build build -- --quiet

say "running the tests"
ctest --test-dir build --output-on-failure --parallel 2 "${labels[@]}"

if $all; then
  say "fuzzing"
  tests/fuzz/run.sh 60
fi
