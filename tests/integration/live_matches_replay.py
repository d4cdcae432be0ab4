# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""The daemon's pose of every scan, over UDP and TCP, equals that of a replay, bit for bit.

usage: live_matches_replay.py GLINT GLINTD CONFIG
Simulates a walk, replays it, and sends the same capture over loopback to the daemon at the recorded
speed while a subscribed client and one that asks ten times a second read the pose.
"""
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "clients", "python"))
from glint_client import Client

SECONDS = 6


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def key_of(pose):
    return pose["t"], tuple(pose["p_m"] + pose["q_xyzw"])


def run(glint, glintd, config, directory):
    world = os.path.join(directory, "world")
    capture, meta = os.path.join(world, "capture.pcap"), os.path.join(world, "metadata.json")
    subprocess.run([glint, "simulate", "--world", "room", "--seconds", str(SECONDS), "--seed", "7", "--out", world],
                   check=True, stdout=subprocess.DEVNULL)
    replayed = os.path.join(directory, "replay")
    subprocess.run([glint, "replay", capture, "--meta", meta, "--out", replayed], check=True,
                   stdout=subprocess.DEVNULL)
    expected = {}
    for line in open(os.path.join(replayed, "odometry.tum")):
        t, *values = line.split()
        expected[t] = tuple(float(v) for v in values)
    assert len(expected) == 10 * SECONDS - 1, len(expected)

    lidar, imu, tcp = free_port(socket.SOCK_DGRAM), free_port(socket.SOCK_DGRAM), free_port(socket.SOCK_STREAM)
    # A machine too busy to keep up would leave keypoints out.
    settings = {"slam.load_level": "none",
                "sensor.lidar_port": lidar, "sensor.imu_port": imu, "sensor.bind_address": "127.0.0.1",
                "server.listen": f"127.0.0.1:{tcp}", "server.unix_socket": "",
                "state.directory": os.path.join(directory, "state")}
    command = [glintd, "--config", config, "--source", "udp", "--meta", meta]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    daemon = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    try:
        poller = Client(f"127.0.0.1:{tcp}", wait_s=20)
        subscription = poller.subscribe("pose", frame="odom")
        sender = subprocess.Popen([glint, "emulate", capture, "--meta", meta, "--to", f"127.0.0.1:{lidar}",
                                   "--imu-port", str(imu), "--rate", "1"], stdout=subprocess.DEVNULL)
        polled, subscribed = {}, {}
        while sender.poll() is None:
            pose = poller.get_pose("odom")
            if "frame_id" in pose:
                polled[key_of(pose)[0]] = key_of(pose)[1]
            time.sleep(0.1)
        assert sender.returncode == 0
        last = max(expected, key=float)
        for pose in subscription:
            assert pose["missed"] == 0, pose
            subscribed[key_of(pose)[0]] = key_of(pose)[1]
            if pose["t"] == last:
                break
        counters = poller.get_status()["counters"]
        assert counters["lidar_packets"] == 64 * 10 * SECONDS, counters
        for lost in ("kernel_drops", "queue_drops", "missing_packets", "late_packets", "incomplete_scans"):
            assert counters[lost] == 0, counters
        different = [t for t in expected if subscribed.get(t) != expected[t]]
        assert not different, f"{len(different)} of {len(expected)} poses differ, the first at {different[0]}"
        # The first scan has no pose yet; every answer to the poller is one that the replay knows.
        assert len(polled) > 5 * SECONDS, len(polled)
        assert all(expected[t] == value for t, value in polled.items() if t in expected)
        assert len([t for t in polled if t not in expected]) <= 1
    finally:
        daemon.send_signal(signal.SIGTERM)
        _, log = daemon.communicate(timeout=20)
        sys.stderr.write(log)
    assert daemon.returncode == 0, daemon.returncode
    print(f"{len(expected)} poses equal bit for bit; {len(polled)} polled at 10 Hz; no packet lost")


def main():
    with tempfile.TemporaryDirectory(prefix="glint-live-") as directory:
        run(*sys.argv[1:4], directory)


if __name__ == "__main__":
    main()
