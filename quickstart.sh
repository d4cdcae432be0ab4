#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# usage: ./quickstart.sh [CAPTURE.pcap METADATA.json]
# From a fresh Debian 12 to a trajectory: installs what the build needs, builds, runs the daemon and a
# replay on a simulated corridor or on your own capture. Results: out/quickstart/. Safe to run again.
set -euo pipefail
cd "$(dirname "$0")"

step="starting"
trap 'status=$?; [ $status -eq 0 ] || echo "quickstart: failed while $step (see above)" >&2' EXIT
say() {
  step="$1"
  echo "quickstart: $1"
}

if [ $# -ne 0 ] && [ $# -ne 2 ]; then
  echo "usage: ./quickstart.sh [CAPTURE.pcap METADATA.json]" >&2
  exit 2
fi
for file in "$@"; do
  [ -r "$file" ] || { echo "quickstart: cannot read $file" >&2; exit 3; }
done

out=out/quickstart
mkdir -p "$out"

say "installing the packages that the build needs"
.ci/install-packages build

say "building build/glint and build/glintd (Release)"
tests=OFF
grep -qs '^GLINT_BUILD_TESTS:BOOL=ON' build/CMakeCache.txt && tests=ON
cmake --preset release -DGLINT_BUILD_TESTS=$tests >"$out/configure.log" || { cat "$out/configure.log"; exit 1; }
cmake --build build --target glint glintd -- --quiet

truth=()
if [ $# -eq 2 ]; then
  capture=$1 metadata=$2
else
  say "simulating 30 s in a corridor"
  build/glint simulate --world corridor --seconds 30 --seed 1 --profile RNG19_RFL8_SIG16_NIR16 \
    --out "$out/simulated"
  capture=$out/simulated/capture.pcap metadata=$out/simulated/metadata.json
  truth=(--truth "$out/simulated/groundtruth_100hz.tum")
fi

say "running glintd on the capture and asking it as a client would"
socket=$PWD/$out/glintd.sock
build/glintd --config config/glint.toml --source "pcap:$capture" --meta "$metadata" --rate 4 \
  --set "server.listen=" --set "server.unix_socket=$socket" --set "state.directory=$PWD/$out/state" \
  2>"$out/glintd.log" &
daemon=$!
trap 'status=$?; kill $daemon 2>/dev/null || true; [ $status -eq 0 ] || echo "quickstart: failed while $step (see above and $out/glintd.log)" >&2' EXIT
for _ in $(seq 100); do
  build/glint pose --connect "$socket" --json 2>/dev/null | grep -qs '"state":"\(TRACKING\|DEGRADED\)"' && break
  kill -0 $daemon 2>/dev/null || { cat "$out/glintd.log" >&2; exit 1; }
  sleep 0.1
done
build/glint pose --connect "$socket"
build/glint status --connect "$socket"

say "stopping glintd"
kill -TERM $daemon
wait $daemon
trap 'status=$?; [ $status -eq 0 ] || echo "quickstart: failed while $step (see above)" >&2' EXIT

say "replaying the capture into $out"
build/glint replay "$capture" --meta "$metadata" --out "$out" "${truth[@]}"

for file in trajectory.tum map.ply report.html summary.json; do
  [ -s "$out/$file" ] || { echo "quickstart: $out/$file is missing" >&2; exit 1; }
done
echo "quickstart: done; look at $out/report.html"
echo "quickstart: with a sensor: put its metadata file and UDP port into /etc/glint/glint.toml (see config/glint.toml) and start glintd; with your own capture: ./quickstart.sh CAPTURE.pcap METADATA.json"
