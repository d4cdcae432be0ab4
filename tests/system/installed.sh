#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
#
# usage: tests/system/installed.sh PACKAGE.deb | --build BUILD_DIRECTORY
# The package in a fresh Debian 12 that is booted with its own systemd: what operators expect of the service. Needs
# root, debootstrap and systemd-nspawn; takes some five minutes.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

for tool in debootstrap systemd-nspawn nsenter; do
  command -v "$tool" >/dev/null || {
    echo "installed.sh: needs $tool (apt-get install debootstrap systemd-container)" >&2
    exit 77
  }
done
[ "$(id -u)" -eq 0 ] || { echo "installed.sh: needs root" >&2; exit 77; }

if [ "$1" = --build ]; then
  cmake --build "$2" --target package >/dev/null
  package=$(ls -t "$2"/glint_*.deb | head -n 1)
else
  package=$(readlink -f "$1")
fi
# A root that is there is used again.
work=${GLINT_INSTALLED_ROOT:-$(mktemp -d /var/tmp/glint-installed-XXXXXX)}
mkdir -p "$work"
root=$work/root
machine=
finish() {
  local status=$?
  [ $status -eq 0 ] || journal 2>/dev/null | tail -n 40 >&2 || true
  # The simulated sensor came from outside: a shutdown would wait for it.
  [ -z "${leader:-}" ] || inside pkill -KILL -x glint || true
  [ -z "$machine" ] || { kill "$machine" 2>/dev/null; wait "$machine" 2>/dev/null; } || true
  [ -n "${GLINT_INSTALLED_ROOT:-}" ] || rm -rf "$work"
  exit $status
}
trap finish EXIT

say() { echo "installed.sh: $*"; }
fail() { echo "installed.sh: $*" >&2; exit 1; }
inside() { nsenter --all --target "$leader" -- "$@"; }
journal() { inside journalctl -u glintd --no-pager -o cat; }
# await SECONDS COMMAND...: until it succeeds.
await() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || fail "not within its time: $*"
    sleep 0.3
  done
}
property() { inside systemctl show -P "$1" glintd.service; }
active() { [ "$(property ActiveState)" = active ] && [ "$(property SubState)" = running ]; }
state_is() { inside glint status --json | grep >/dev/null "\"state\":\"$1\""; }
answers() { inside glint status --json; }
restarted() { [ "$(property NRestarts)" -gt "$1" ] && active; }
# A simulated sensor, that begins to send now.
send() { inside glint simulate --world room --seconds 300 --seed 1 --to 127.0.0.1:7502 >/dev/null 2>&1 & }

mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -n 1)
if [ ! -e "$root/etc/debian_version" ]; then
  say "debootstrap into $root"
  debootstrap --variant=minbase --include=ca-certificates,systemd,systemd-sysv,procps \
    bookworm "$root" "$mirror" >"$work/debootstrap.log" || { tail "$work/debootstrap.log" >&2; exit 1; }
fi
cp "$package" "$root/root/glint.deb"
say "installing"
systemd-nspawn -q -D "$root" --pipe --register=no --keep-unit sh -ec \
  'dpkg -P glint 2>/dev/null || true; apt-get update -qq; DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends lintian /root/glint.deb' \
  >"$work/install.log" 2>&1 || { tail -n 30 "$work/install.log" >&2; exit 1; }
systemd-nspawn -q -D "$root" --pipe --register=no --keep-unit \
  lintian --fail-on error --suppress-tags bad-distribution-in-changes-file /root/glint.deb ||
  fail "lintian finds errors in the package"
say "lintian finds no errors"

say "booting"
systemd-nspawn -q -D "$root" --boot --console=pipe --register=no --keep-unit --private-network \
  >"$work/boot.log" 2>&1 </dev/null &
machine=$!
leader=
for _ in $(seq 100); do
  leader=$(pgrep -P "$machine" | head -n 1 || true)
  [ -n "$leader" ] && [ "$(cat "/proc/$leader/comm")" = systemd ] && break
  sleep 0.1
done
await 60 inside systemctl is-active multi-user.target
[ "$(property ActiveState)" = inactive ] || fail "without a sensor's name the boot leaves the unit $(property ActiveState)"

inside glint simulate --world room --seconds 1 --seed 1 --out /etc/glint/sensor >/dev/null
mkdir -p "$root/etc/glint/glint.toml.d"
cat >"$root/etc/glint/glint.toml.d/sensor.toml" <<END
[sensor]
metadata_file = "/etc/glint/sensor/metadata.json"
source_address = "127.0.0.1"
END
inside systemctl -q enable --now glintd.service
active || fail "the unit does not start without a sensor"
await 10 answers
say "READY, and answers while there is no sensor"

send
await 60 state_is TRACKING
for place in 127.0.0.1:7788 /run/glint/glintd.sock; do
  inside glint pose --json --connect "$place" | grep '"p_m"' >/dev/null || fail "no pose at $place"
done
inside systemctl start glint-wait-localized.service || fail "the unit that waits for the place fails"
say "a sensor that appears later is tracked; its pose is on both sockets; who waits for it goes on"

for exposure in "$(inside systemd-analyze security glintd.service | sed -n 's/.*exposure level for glintd.service: \([0-9.]*\).*/\1/p')"; do
  say "exposure $exposure"
  [ "$(echo "$exposure" | tr -d .)" -le 12 ] || fail "exposure $exposure, more than 1.2"
done

before=$(property NRestarts)
kill -9 "$(pgrep -P "$leader" -x glintd)"
await 20 restarted "$before"
await 60 state_is TRACKING
say "kill -9: it is started again and tracks"

before=$(property NRestarts)
# From outside of the machine: nothing in the product or the root helps with it.
python3 "$here/freeze_thread.py" "$(pgrep -P "$leader" -x glintd)" backend &
await 75 restarted "$before"
journal | grep "glintd.service: Watchdog timeout" >/dev/null || fail "it was not the watchdog"
say "a thread that hangs: the watchdog has it started again"

cp "$root/etc/glint/glint.toml.d/sensor.toml" "$work/sensor.toml"
printf '[slam]\nprest = "full"\n' >"$root/etc/glint/glint.toml.d/wrong.toml"
inside systemctl restart glintd.service 2>/dev/null && fail "a wrong configuration starts"
sleep 4
[ "$(property ExecMainStatus)" = 78 ] || fail "exit status $(property ExecMainStatus), not 78"
[ "$(property ActiveState)" = failed ] || fail "it is tried again with a wrong configuration"
journal | grep "wrong.toml.*2.*prest" >/dev/null || fail "the journal does not name file, line and key"
rm "$root/etc/glint/glint.toml.d/wrong.toml"
say "a wrong configuration: exit 78, not started again, file and line in the journal"

inside systemctl reset-failed glintd.service
inside systemctl start glintd.service
await 10 answers
process=$(property MainPID)
printf '[log]\nlevel = "debug"\n' >"$root/etc/glint/glint.toml.d/talk.toml"
inside systemctl reload glintd.service
told() { journal | grep "$1" >/dev/null; }
await 10 told "reload: log.level is debug"
[ "$(property MainPID)" = "$process" ] || fail "it does not outlive a reload"
rm "$root/etc/glint/glint.toml.d/talk.toml"
say "reload: the same process does what the configuration says now"

inside systemctl stop glintd.service
inside mount -t tmpfs -o mode=0755 tmpfs /var/lib/private/glint
inside systemctl start glintd.service
await 10 answers
inside systemctl stop glintd.service
inside mount -o remount,ro /var/lib/private/glint
inside systemctl start glintd.service
await 60 state_is TRACKING
await 60 sh -c "nsenter --all --target $leader -- glint status --json | grep -q '\"store_failures\":[1-9]'"
inside systemctl stop glintd.service
inside umount /var/lib/private/glint
say "a state directory that is only read: it tracks, and says so"

inside mount -t tmpfs -o size=1m,mode=0755 tmpfs /var/lib/private/glint
inside systemctl start glintd.service
await 60 state_is TRACKING
await 60 sh -c "nsenter --all --target $leader -- glint status --json | grep -q '\"store_failures\":[1-9]'"
state_is TRACKING || fail "it does not track while the disk is full"
await 20 sh -c "nsenter --all --target $leader -- journalctl -u glintd -o json GLINT_COUNTER=store_failures | grep -q '\"PRIORITY\":\"4\".*'"
inside systemctl stop glintd.service
inside umount /var/lib/private/glint
say "a full disk: it tracks on, and says so"

inside systemctl stop glintd.service
inside useradd --no-create-home --groups glint pilot
inside useradd --no-create-home stranger
inside systemctl -q enable --now glintd.socket
[ "$(property ActiveState)" = inactive ] || fail "the socket's unit starts the service without a client"
inside runuser -u stranger -- glint status --json --connect /run/glintd.sock >/dev/null 2>&1 && fail "everybody may use the socket"
[ "$(property ActiveState)" = inactive ] || fail "who may not connect starts the service"
inside runuser -u pilot -- glint status --json --connect /run/glintd.sock >/dev/null ||
  fail "a member of the group glint is not served by the service it starts"
active || fail "a client at the socket does not start the service"
await 60 state_is TRACKING
inside runuser -u pilot -- glint pose --json --connect /run/glintd.sock | grep '"p_m"' >/dev/null || fail "no pose at the socket"
say "glintd.socket: the group's members are served, and the first of them starts the service"

process=$(property MainPID)
dpkg-deb -R "$root/root/glint.deb" "$work/newer"
sed -i 's/^Version: .*/&+newer/' "$work/newer/DEBIAN/control"
dpkg-deb -b "$work/newer" "$root/root/newer.deb" >/dev/null
rm -rf "$work/newer"
inside dpkg -i /root/newer.deb >/dev/null 2>&1
await 20 active
[ "$(property MainPID)" != "$process" ] || fail "the old process goes on after an upgrade"
await 60 state_is TRACKING
say "an upgrade while it runs: the new one tracks"

inside dpkg -r glint >/dev/null 2>&1
[ ! -e "$root/usr/bin/glintd" ] || fail "removed, but glintd is there"
[ -e "$root/etc/glint/glint.toml" ] || fail "removing takes the configuration away"
[ -d "$root/var/lib/private/glint" ] || fail "removing takes the maps away"
inside dpkg -i /root/newer.deb >/dev/null 2>&1
[ "$(inside systemctl is-enabled glintd.service)" = enabled ] || fail "enabled before the removal, not after it"
inside systemctl start glintd.service
await 60 state_is TRACKING
inside dpkg -r glint >/dev/null 2>&1
inside dpkg -P glint >/dev/null 2>&1
[ ! -e "$root/etc/glint/glint.toml" ] && [ ! -e "$root/var/lib/private/glint" ] && [ ! -e "$root/var/lib/glint" ] ||
  fail "something is left after a purge"
[ -z "$(find "$root/etc/systemd" -name '*glint*')" ] || fail "links of units are left after a purge"
say "remove keeps configuration and maps, purge leaves nothing"
say "all as operators expect"
