# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""Replays simulated worlds and holds the trajectory against the truth.

usage: simulated_worlds.py GLINT SECONDS SEED...
For each world, seed and preset: every scan after the first has a pose, and the position error (RMSE after
rigid alignment) stays below 1.5 % of the path with preset `paper`, 0.6 % with `full`, plus 5 cm.
Prints a line each, so that it also serves for measuring.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

LIMITS = {"paper": 0.015, "full": 0.006}


def main():
    glint, seconds, seeds = sys.argv[1], sys.argv[2], sys.argv[3:]
    failures = 0
    for world in ("corridor", "room"):
        for seed in seeds:
            with tempfile.TemporaryDirectory(prefix="glint-world-") as directory:
                at = pathlib.Path(directory)
                subprocess.run([glint, "simulate", "--world", world, "--seconds", seconds, "--seed", seed, "--out", at],
                               check=True, stdout=subprocess.DEVNULL)
                for preset, limit in LIMITS.items():
                    subprocess.run([glint, "replay", at / "capture.pcap", "--out", at / preset, "--preset", preset,
                                    "--truth", at / "groundtruth_100hz.tum"], check=True, stdout=subprocess.DEVNULL)
                    summary = json.loads((at / preset / "summary.json").read_text())
                    truth = summary["truth"]
                    good = (truth["ate_rmse_m"] < 0.05 + limit * truth["path_m"] and
                            summary["frames_with_pose"] == summary["frames"] - 1)
                    failures += not good
                    print(f"{world} {seed} {preset}: {truth['ate_rmse_m']:.3f} m RMSE over {truth['path_m']:.1f} m, "
                          f"{summary['frames_with_pose']} of {summary['frames']} scans"
                          f"{'' if good else ': TOO FAR OFF'}", flush=True)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
