#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""Wakes a sensor up all over simulated maps and tells how often it finds its place: a line a world, seed and way.

The map is of the world's own way. The sensor then goes it again in other ways, with 30 mm of range noise, and wakes up
every 4 s with 2 s to be found (see relocalization.cpp, which does the work): `back` turned round and beside it,
`swing` looking to either side by up to 100 degrees and swaying, `other` with the gait of a walker at another height.
`foreign`: in a world of another seed, where nothing may be found.
"""
from __future__ import annotations

import argparse
import pathlib
import re
import subprocess
import sys

import numpy as np

WORLDS = ["building", "street", "parking", "stairs"]
FIGURES = re.compile(r"found (\d+) of (\d+), (\d+) elsewhere, (\d+) wrong")
# Where the floor is one, the way can be left to either side by so much without walking into things.
BESIDE_M = {"building": 0.3, "street": 0.8, "parking": 0.8, "stairs": 0.3}


def quaternion_about_z(angle_rad: np.ndarray) -> np.ndarray:
    zero = np.zeros_like(angle_rad)
    return np.stack([zero, zero, np.sin(angle_rad / 2), np.cos(angle_rad / 2)], axis=1)


def times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Hamilton products, x y z w."""
    av, aw, bv, bw = a[:, :3], a[:, 3:], b[:, :3], b[:, 3:]
    vector = aw * bv + bw * av + np.cross(av, bv)
    return np.hstack([vector, aw * bw - np.sum(av * bv, axis=1, keepdims=True)])


def heading_of(way: np.ndarray) -> np.ndarray:
    """Direction of travel of each pose, smoothed over a second either side, rad; that before while it stands."""
    ahead = np.minimum(np.arange(len(way)) + 10, len(way) - 1)
    behind = np.maximum(np.arange(len(way)) - 10, 0)
    step_m = way[ahead, 1:3] - way[behind, 1:3]
    heading = np.arctan2(step_m[:, 1], step_m[:, 0])
    moving = np.hypot(step_m[:, 0], step_m[:, 1]) > 0.05
    last = np.maximum.accumulate(np.where(moving, np.arange(len(way)), 0))
    return heading[last]


def beside(way: np.ndarray, left_m: np.ndarray) -> np.ndarray:
    heading = heading_of(way)
    out = way.copy()
    out[:, 1] -= left_m * np.sin(heading)
    out[:, 2] += left_m * np.cos(heading)
    return out


def turned(way: np.ndarray, angle_rad: np.ndarray) -> np.ndarray:
    out = way.copy()
    out[:, 4:8] = times(way[:, 4:8], quaternion_about_z(angle_rad))
    return out


def back(way: np.ndarray, side_m: float) -> np.ndarray:
    out = turned(way, np.full(len(way), np.pi))[::-1].copy()
    out[:, 0] = way[-1, 0] - out[:, 0] + way[0, 0]
    return beside(out, np.full(len(out), side_m))


def swing(way: np.ndarray, side_m: float) -> np.ndarray:
    t = way[:, 0]
    return turned(beside(way, side_m * np.sin(t / 3.0)), np.radians(100.0) * np.sin(t / 5.0 + 1.0))


def other(way: np.ndarray, side_m: float) -> np.ndarray:
    t = way[:, 0]
    out = turned(beside(way, np.full(len(way), -side_m)), np.full(len(way), np.radians(70.0)))
    out[:, 3] += 0.15 + 0.02 * np.sin(t * 2 * np.pi * 1.8)
    return out


WAYS = {"back": back, "swing": swing, "other": other}


def true_way(glint: pathlib.Path, world: str, seed: int, seconds: int, work: pathlib.Path) -> np.ndarray:
    """The way of a world: t x y z qx qy qz qw, at the scans' ends. It does not depend on the optics."""
    out = work / f"{world}-{seed}-{seconds}"
    if not (out / "groundtruth.tum").exists():
        subprocess.run([glint, "simulate", "--world", world, "--seed", str(seed), "--seconds", str(seconds), "--beams",
                        "16", "--columns", "512", "--out", out], check=True, stdout=subprocess.DEVNULL)
        for capture in out.glob("*.pcap"):
            capture.unlink()
    return np.loadtxt(out / "groundtruth.tum", ndmin=2)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"), help="has glint and the benchmark")
    parser.add_argument("--worlds", nargs="+", default=WORLDS, help="of: %(default)s")
    parser.add_argument("--seeds", nargs="+", type=int, default=[2, 3])
    parser.add_argument("--seconds", type=int, default=120, help="of map, s")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("/tmp/glint-relocalization"))
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    total = np.zeros(4, dtype=int)
    for world in arguments.worlds:
        for seed in arguments.seeds:
            way = true_way(arguments.build / "glint", world, seed, arguments.seconds, arguments.work)
            simulation = f"{world},seed={seed},seconds={arguments.seconds}"
            queries = []
            for name, make in WAYS.items():
                file = arguments.work / f"{world}-{seed}-{arguments.seconds}-{name}.tum"
                np.savetxt(file, make(way, BESIDE_M.get(world, 0.5)), fmt="%.9f")
                queries.append(f"{simulation},trajectory={file},range-noise=0.03")
            queries.append(f"{world},seed={seed + 1},seconds={arguments.seconds}")
            run = subprocess.run([arguments.build / "tests/bench/relocalization", simulation, *queries], check=True,
                                 capture_output=True, text=True)
            print(run.stdout, end="", file=sys.stderr, flush=True)
            for name, found in zip([*WAYS, "foreign"], FIGURES.findall(run.stdout), strict=True):
                counts = np.array(found, dtype=int)
                # In another seed's world no wake counts as one that should be found.
                if name == "foreign":
                    print(f"{world} {seed} foreign: {max(counts[0], counts[3])} of {counts[1]} found in a map of another world", flush=True)
                else:
                    total += counts
                    print(f"{world} {seed} {name}: {counts[0]} of {counts[1]} found, {counts[3]} wrong", flush=True)
    print(f"all: {total[0]} of {total[1]} found ({100.0 * total[0] / max(1, total[1]):.0f} %), {total[3]} wrong")


if __name__ == "__main__":
    main()
