#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# usage: tests/fuzz/run.sh [SECONDS [TARGET...]]
# Builds the fuzzers with clang and runs each target, or those named, for so many seconds (60), two at
# a time (GLINT_FUZZ_JOBS). Prints executions per target; fails when one finds something. What they
# learn is kept in build-fuzz/corpus for the next run, what they find in build-fuzz/findings.
set -euo pipefail
cd "$(dirname "$0")/../.."

seconds="${1:-60}"
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(ls tests/fuzz/corpus)

# Longest input that a target is given, bytes: what its formats need and it gets through quickly.
max_len() {
  case "$1" in
    recording) echo 20000 ;;
    capture | metadata | config) echo 8000 ;;
    *) echo 3000 ;;
  esac
}

run_target() {
  local target=$1 seconds=$2
  local log=build-fuzz/findings/$target.log
  mkdir -p "build-fuzz/corpus/$target" build-fuzz/findings
  local status=0
  # The timeout is of the wall clock, and the machine may be busy: inputs take milliseconds.
  "build-fuzz/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -max_len="$(max_len "$target")" \
    -timeout=60 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="build-fuzz/findings/$target-" \
    "build-fuzz/corpus/$target" "tests/fuzz/corpus/$target" >"$log" 2>&1 || status=$?
  local executions
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  if [ $status -ne 0 ]; then
    echo "fuzz: $target found something (exit $status): see $log"
    grep -E 'ERROR|SUMMARY|does not hold|Test unit written' "$log" | sed 's/^/fuzz:   /' || true
    return 1
  fi
  echo "fuzz: $target: $executions executions in $seconds s"
}
export -f run_target max_len

cmake --preset fuzz >/dev/null
cmake --build --preset fuzz -- --quiet
printf '%s\n' "${targets[@]}" |
  xargs -P "${GLINT_FUZZ_JOBS:-2}" -I{} bash -c 'run_target "$1" "$2"' _ {} "$seconds"
echo "fuzz: nothing found"
