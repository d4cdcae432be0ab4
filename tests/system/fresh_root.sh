#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# usage: tests/system/fresh_root.sh [WORK_DIRECTORY]
# The README's two commands in a fresh minimal Debian 12: debootstrap makes a root without a compiler,
# a clean checkout of HEAD goes in, and ./quickstart.sh (at most 10 minutes) and ./test.sh (at most 15)
# run there as written. Needs root, debootstrap and systemd-nspawn; takes about 20 minutes.
set -euo pipefail
project=$(cd "$(dirname "$0")/../.." && pwd)
data=${GLINT_DATA_DIR:-$project/../shared/data}

for tool in debootstrap systemd-nspawn git; do
  command -v "$tool" >/dev/null || {
    echo "fresh_root.sh: needs $tool (apt-get install debootstrap systemd-container git)" >&2
    exit 77
  }
done
[ "$(id -u)" -eq 0 ] || { echo "fresh_root.sh: needs root" >&2; exit 77; }

work=${1:-$(mktemp -d /var/tmp/glint-fresh-XXXXXX)}
[ $# -gt 0 ] || trap 'rm -rf "$work"' EXIT
root=$work/root
# The mirror that this machine itself uses.
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -n 1)
if [ ! -e "$root/etc/debian_version" ]; then
  echo "fresh_root.sh: debootstrap into $root"
  debootstrap --variant=minbase --include=ca-certificates bookworm "$root" "$mirror" >"$work/debootstrap.log" ||
    { tail "$work/debootstrap.log" >&2; exit 1; }
fi
rm -rf "$root/home/glint"
git clone -q --no-hardlinks "$project" "$root/home/glint/project"

# Some tests make networks of their own.
inside=(systemd-nspawn -q -D "$root" --pipe --register=no --keep-unit --capability=CAP_NET_ADMIN
  --chdir=/home/glint/project)
if [ -d "$data" ]; then
  mkdir -p "$root/home/glint/data"
  inside+=(--bind-ro="$(readlink -f "$data"):/home/glint/data" --setenv=GLINT_DATA_DIR=/home/glint/data)
fi
[ -z "${CI:-}" ] || inside+=(--setenv=CI="$CI")

timed() {  # timed LIMIT_S COMMAND...: within its limit, as README promises
  local limit=$1 started=$SECONDS
  shift
  echo "fresh_root.sh: $*"
  timeout "$((2 * limit))" "${inside[@]}" "$@"
  local took=$((SECONDS - started))
  echo "fresh_root.sh: $* took $took s"
  [ $took -le "$limit" ] || { echo "fresh_root.sh: longer than $limit s" >&2; exit 1; }
}
timed 600 ./quickstart.sh
for file in trajectory.tum map.ply report.html summary.json; do
  [ -s "$root/home/glint/project/out/quickstart/$file" ] || { echo "no $file" >&2; exit 1; }
done
timed 900 ./test.sh
echo "fresh_root.sh: both commands succeed in a fresh Debian 12"
