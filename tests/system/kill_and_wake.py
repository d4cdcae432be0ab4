# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""A daemon that is killed at any moment keeps its map, finds itself in it again and goes on in its frame.

usage: kill_and_wake.py GLINT GLINTD CONFIG [--kills N] [--seed S]
The daemon maps a simulated building (map.on_start = continue) and is ended by SIGKILL at a random moment, again and
again; each time the robot wakes up elsewhere on its walk. After each kill the session files must be sound and hold
every keyframe that a client was told of a second before; after each start the pose must be the true one in the frame
of the first run's map, without a command. Prints what it measured.
"""
import argparse
import bisect
import glob
import os
import random
import signal
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from glintd_process import free_port  # noqa: E402
from glint_client import Client  # noqa: E402

WORLD = {"seed": 4, "columns": 512}
WALK_S, MAPPED_S, SPEED = 60, 24.0, 2
TOLD_BEFORE_S = 1.0
# Of what the map itself errs by, and the pose in it: a place that is taken for another is metres off.
WITHIN_M = 0.3
PATIENCE_S = 60.0


class Walk:
    """The true way through the building, and where it lies in the frame of a map begun at its start."""

    def __init__(self, glint, directory):
        self.directory = directory
        world = os.path.join(directory, "world")
        options = [f"--{key}={value}" for key, value in WORLD.items()]
        # The walk is the same whatever the sensor; few beams are simulated sooner.
        subprocess.run([glint, "simulate", "--world", "building", *options, "--beams", "16", "--seconds", str(WALK_S),
                        "--out", world], check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(world, "groundtruth_100hz.tum"), encoding="utf-8") as file:
            self.lines = file.readlines()
        values = [[float(v) for v in line.split()] for line in self.lines]
        self.t_s = [v[0] for v in values]
        origin, (x, y, z, w) = values[0][1:4], values[0][4:8]
        rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        self.in_map_m = [[sum(rows[k][i] * (v[1 + k] - origin[k]) for k in range(3)) for i in range(3)] for v in values]

    def source(self, begin_s):
        """A simulation of the walk from there on; its clock begins anew."""
        first = bisect.bisect_left(self.t_s, self.t_s[0] + begin_s)
        file = os.path.join(self.directory, "rest.tum")
        with open(file, "w", encoding="utf-8") as rest:
            rest.writelines(self.lines[first:])
        options = ",".join(f"{key}={value}" for key, value in WORLD.items())
        return f"synth:building,{options},seconds={WALK_S - begin_s:.0f},trajectory={file}"

    def off_m(self, begin_s, t_ns, p_m):
        """How far a pose in the map is from the true one at that time."""
        t_s = t_ns * 1e-9 + begin_s
        i = min(max(bisect.bisect_left(self.t_s, t_s), 1), len(self.t_s) - 1)
        share = (t_s - self.t_s[i - 1]) / (self.t_s[i] - self.t_s[i - 1])
        true_m = [a + share * (b - a) for a, b in zip(self.in_map_m[i - 1], self.in_map_m[i])]
        return sum((a - b) ** 2 for a, b in zip(p_m, true_m)) ** 0.5


class Daemon:
    """One start of the daemon, and what it told."""

    def __init__(self, glintd, config, source, state, log):
        self.port = free_port()
        command = [glintd, "--config", config, "--source", source, "--rate", str(SPEED)]
        for key, value in {"server.listen": f"127.0.0.1:{self.port}", "server.unix_socket": "",
                           "state.directory": state, "map.on_start": "continue"}.items():
            command += ["--set", f"{key}={value}"]
        self.process = subprocess.Popen(command, stderr=log)
        self.client = Client(f"127.0.0.1:{self.port}", timeout_s=20, wait_s=20)
        self.told = []  # When, in which file, how many keyframes.
        self.keyframes = 0  # Of the map, as told last.
        self.poses = {}

    def look(self):
        """Takes note of a pose and of what the status tells; True while the place in the map is known."""
        status = self.client.get_status()
        self.keyframes = status["map"]["keyframes"]
        # Until a large map is whole, what is new waits: no session is told of.
        if status.get("session_file"):
            # What is told is published before the answer comes.
            self.told.append((time.monotonic(), status["session_file"], status["map"]["keyframes"]))
        pose = self.client.get_pose(frame="map")
        if pose["state"] not in ("TRACKING", "DEGRADED") or "p_m" not in pose:
            return False
        self.poses[pose["t_ns"]] = pose["p_m"]
        return True

    def watch(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.look()
            time.sleep(0.02)

    def wait_until_placed(self):
        begin = time.monotonic()
        while not self.look():
            assert time.monotonic() - begin < PATIENCE_S, "the place in the map was not found"
            assert self.process.poll() is None, "the daemon ended by itself"
            time.sleep(0.02)
        return time.monotonic() - begin

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        return time.monotonic()


def check_sessions(state, daemon, killed):
    """Every session is sound, and the one that was told of holds what was told in time."""
    for file in glob.glob(os.path.join(state, "session-*.glint")):
        with sqlite3.connect(f"file:{file}?mode=ro", uri=True) as database:
            assert database.execute("PRAGMA quick_check").fetchone()[0] == "ok", file
    in_time = [t for t in daemon.told if t[0] < killed - TOLD_BEFORE_S]
    if not in_time:
        return 0
    _, file, keyframes = in_time[-1]
    with sqlite3.connect(f"file:{file}?mode=ro", uri=True) as database:
        held = database.execute("SELECT count(*) FROM keyframes").fetchone()[0]
    assert held >= keyframes, f"{file} holds {held} keyframes, {keyframes} were told of"
    return held


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("glint")
    parser.add_argument("glintd")
    parser.add_argument("config")
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    chance = random.Random(options.seed)
    with tempfile.TemporaryDirectory(prefix="glint-kills-") as directory, \
            open(os.path.join(directory, "log"), "w+", encoding="utf-8") as log:
        state = os.path.join(directory, "state")
        os.mkdir(state)
        daemon = None
        try:
            walk = Walk(options.glint, directory)
            searched_s, off_m, held, mapped = [], [], 0, 0
            daemon = Daemon(options.glintd, options.config, walk.source(0.0), state, log)
            for kill in range(options.kills):
                begin_s = 0.0 if kill == 0 else chance.uniform(0.0, MAPPED_S - 4.0)
                if kill > 0:
                    daemon = Daemon(options.glintd, options.config, walk.source(begin_s), state, log)
                if kill > 0 and chance.random() < 0.1:
                    # While it still looks for its place.
                    daemon.watch(chance.uniform(0.0, 1.0))
                else:
                    searched_s.append(daemon.wait_until_placed())
                    assert daemon.keyframes >= mapped, "it goes on in another map"
                    daemon.watch(MAPPED_S / SPEED if kill == 0 else chance.uniform(0.2, 3.5))
                mapped = check_sessions(state, daemon, daemon.kill()) or mapped
                away = [walk.off_m(begin_s, t_ns, p_m) for t_ns, p_m in daemon.poses.items()]
                off_m += away
                assert not away or max(away) < WITHIN_M, f"start {kill} at {begin_s:.1f} s: {max(away):.3f} m off"
            print(f"{options.kills} kills: every session sound, nothing told of a second before lost, "
                  f"{mapped} keyframes at last; the place found after {statistics.median(searched_s[1:]):.1f} s "
                  f"({max(searched_s[1:]):.1f} s at most), {len(off_m)} poses off by "
                  f"{statistics.median(off_m):.3f} m ({max(off_m):.3f} m at most)")
        except BaseException:
            log.seek(0)
            sys.stderr.write("".join(log.readlines()[-60:]))
            raise
        finally:
            if daemon and daemon.process.poll() is None:
                daemon.kill()


if __name__ == "__main__":
    main()
