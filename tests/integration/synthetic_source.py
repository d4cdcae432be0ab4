# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""A simulated sensor is the same sensor in a capture, inside the daemon, and on the wire.

usage: synthetic_source.py GLINT GLINTD CONFIG
Replays a simulated capture, then runs the daemon on the same simulation, once as its own source and once fed by
`glint simulate --to`, and compares the pose of every scan, bit for bit.
"""
import os
import signal
import socket
import subprocess
import sys
import tempfile

from live_matches_replay import Client, free_port, key_of

SECONDS, SEED, WORLD = 3, 7, "room"


def simulate(glint, *more):
    return [glint, "simulate", "--world", WORLD, "--seconds", str(SECONDS), "--seed", str(SEED), *more]


def poses_of_daemon(glintd, config, source, settings, last, start):
    """Pose by time of a daemon that runs on `source`; `start()` sets its packets going."""
    tcp = free_port(socket.SOCK_STREAM)
    command = [glintd, "--config", config, *source]
    for key, value in {"server.listen": f"127.0.0.1:{tcp}", "server.unix_socket": "", "state.directory": "",
                       **settings}.items():
        command += ["--set", f"{key}={value}"]
    daemon = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    try:
        subscription = Client(f"127.0.0.1:{tcp}", wait_s=20).subscribe("pose", frame="odom")
        sender = start()
        poses = {}
        for pose in subscription:
            assert pose["missed"] == 0, pose
            poses[key_of(pose)[0]] = key_of(pose)[1]
            if pose["t"] == last:
                break
        assert sender is None or sender.wait() == 0
        return poses
    finally:
        daemon.send_signal(signal.SIGTERM)
        _, log = daemon.communicate(timeout=20)
        sys.stderr.write(log)


def check(name, poses, expected):
    # A client that comes late has missed the first ones.
    assert len(poses) > len(expected) // 2, (name, len(poses))
    different = [t for t, pose in poses.items() if t in expected and pose != expected[t]]
    assert not different, f"{name}: {len(different)} of {len(poses)} poses differ, the first at {different[0]}"
    print(f"{name}: {len(poses)} poses equal bit for bit")


def run(glint, glintd, config, directory):
    subprocess.run(simulate(glint, "--out", directory), check=True, stdout=subprocess.DEVNULL)
    subprocess.run([glint, "replay", os.path.join(directory, "capture.pcap"), "--out", os.path.join(directory, "run")],
                   check=True, stdout=subprocess.DEVNULL)
    expected = {}
    for line in open(os.path.join(directory, "run", "odometry.tum")):
        t, *values = line.split()
        expected[t] = tuple(float(v) for v in values)
    last = max(expected, key=float)

    source = f"synth:{WORLD},seed={SEED},seconds={SECONDS}"
    check("inside", poses_of_daemon(glintd, config, ["--source", source], {}, last, lambda: None), expected)

    lidar, imu = free_port(socket.SOCK_DGRAM), free_port(socket.SOCK_DGRAM)
    meta = os.path.join(directory, "metadata.json")
    ports = {"sensor.lidar_port": lidar, "sensor.imu_port": imu, "sensor.bind_address": "127.0.0.1"}
    to = simulate(glint, "--to", f"127.0.0.1:{lidar}", "--imu-port", str(imu))
    check("on the wire", poses_of_daemon(glintd, config, ["--source", "udp", "--meta", meta], ports, last,
                                         lambda: subprocess.Popen(to, stdout=subprocess.DEVNULL)), expected)


def main():
    with tempfile.TemporaryDirectory(prefix="glint-synth-") as directory:
        run(*sys.argv[1:4], directory)


if __name__ == "__main__":
    main()
