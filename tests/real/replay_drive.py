#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""Replays a real city drive and holds it against a careful offline registration, with each preset.

usage: replay_drive.py GLINT SOURCE_DIR
Every scan after the first must be TRACKING, the position error stay below 1 % of the path, and a second
replay give the same bytes. Exits with 77 (skipped) where DATA/drive is missing (DATA is GLINT_DATA_DIR or
SOURCE_DIR/../shared/data), unless CI=true, where that is a failure.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77
REPEATED = ["odometry.tum", "trajectory.tum", "trajectory.kitti", "times.txt", "map.ply"]


def replay(glint, drive, out, preset):
    subprocess.run([glint, "replay", drive / "drive.pcap", "--meta", drive / "drive.json", "--out", out, "--preset",
                    preset, "--truth", drive / "reference.tum"], check=True, stdout=subprocess.DEVNULL)
    return json.loads((out / "summary.json").read_text())


def main():
    glint, source = sys.argv[1:3]
    drive = pathlib.Path(os.environ.get("GLINT_DATA_DIR") or pathlib.Path(source, "../shared/data")) / "drive"
    if not (drive / "drive.pcap").exists():
        in_ci = os.environ.get("CI") == "true"
        print(f"{'FAILED' if in_ci else 'skipped'}: no {drive}/drive.pcap; set GLINT_DATA_DIR")
        sys.exit(1 if in_ci else SKIPPED)
    with tempfile.TemporaryDirectory(prefix="glint-drive-") as directory:
        for preset in ("paper", "full"):
            first, again = pathlib.Path(directory, preset), pathlib.Path(directory, preset + "-again")
            summary = replay(glint, drive, first, preset)
            replay(glint, drive, again, preset)
            truth = summary["truth"]
            print(f"{preset}: {truth['ate_rmse_m']:.3f} m RMSE over {truth['path_m']:.1f} m")
            assert summary["frames"] == 154, summary["frames"]
            assert summary["frames_with_pose"] == 153, summary["frames_with_pose"]
            assert summary["lost_s"] == 0, summary["lost_s"]
            assert truth["ate_rmse_m"] < 0.01 * truth["path_m"], truth
            for name in REPEATED:
                assert (first / name).read_bytes() == (again / name).read_bytes(), f"{name} differs between two runs"


if __name__ == "__main__":
    main()
