#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""Dumps a real capture and compares every array with what an independent decoder read from it.

usage: compare_expected.py GLINT SOURCE_DIR CAPTURE METADATA EXPECTED

CAPTURE and METADATA name files in DATA/ouster, EXPECTED one in DATA/expected, where DATA is
GLINT_DATA_DIR or SOURCE_DIR/../shared/data. EXPECTED holds arrays named f0_range, f0_xyz, ... and
f0_frame_id; all but XYZ must be equal, XYZ to a micrometre. Exits with 77 (skipped) where the data
or NumPy is missing, unless CI=true, where that is a failure.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77
XYZ_TOLERANCE_M = 1e-6


def give_up(reason):
    """The test cannot be run: skipped on a desk, a failure in continuous integration."""
    in_ci = os.environ.get("CI") == "true"
    print(f"{'FAILED' if in_ci else 'skipped'}: {reason}")
    sys.exit(1 if in_ci else SKIPPED)


try:
    import numpy as np
except ImportError:
    give_up("NumPy is not installed (apt install python3-numpy)")


def difference(field, ours, theirs):
    """What is wrong with one array; None if nothing."""
    if ours.shape != theirs.shape:
        return f"shape {ours.shape}, expected {theirs.shape}"
    if field == "xyz":
        off_m = float(np.abs(ours - theirs).max())
        return None if off_m <= XYZ_TOLERANCE_M else f"off by up to {off_m:.3g} m"
    ours, theirs = ours.astype(np.uint64), theirs.astype(np.uint64)
    if field.startswith("reflectivity") and theirs.max(initial=0) < 256:
        # The expected arrays keep the low byte only of old firmware's 16-bit reflectivity.
        ours = ours & np.uint64(0xFF)
    count = int((ours != theirs).sum())
    return f"{count} of {ours.size} differ" if count else None


def frame_problems(dump, prefix, expected, key):
    """Differences of one frame, each a sentence."""
    fields = [n[len(key):] for n in expected.files if n.startswith(key) and n != key + "frame_id"]
    for field in sorted(fields):
        file = dump / f"{prefix}_{field}.npy"
        problem = (difference(field, np.load(file), expected[key + field])
                   if file.exists() else "no file")
        if problem:
            yield f"{prefix}: {field}: {problem}"
    wanted = set(fields)
    for file in sorted(dump.glob(f"{prefix}_*.npy")):
        field = file.stem[len(prefix) + 1:]
        if field not in wanted:
            yield f"{prefix}: {field}: dumped, but the sensor does not send it"


def compare(dump, expected_file):
    """All differences between a dump and the expected arrays."""
    expected = np.load(expected_file)
    frames = {f["frame_id"]: f["file"] for f in json.loads((dump / "index.json").read_text())["frames"]}
    keys = sorted({name.split("_", 1)[0] + "_" for name in expected.files})
    problems = []
    for key in keys:
        frame_id = int(expected[key + "frame_id"])
        prefix = frames.pop(frame_id, None)
        if prefix is None:
            problems.append(f"frame {frame_id} is missing")
        else:
            problems += frame_problems(dump, prefix, expected, key)
    problems += [f"frame {frame_id} should not be there" for frame_id in frames]
    return len(keys), problems


def main(glint, source_dir, capture, metadata, expected):
    default = pathlib.Path(source_dir).parent / "shared" / "data"
    data = pathlib.Path(os.environ.get("GLINT_DATA_DIR") or default)
    files = [data / "ouster" / capture, data / "ouster" / metadata, data / "expected" / expected]
    for file in files:
        if not file.exists():
            give_up(f"there is no {file}; set GLINT_DATA_DIR to the folder of the captures")
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([glint, "dump", files[0], "--meta", files[1], "--out", folder], check=True)
        count, problems = compare(pathlib.Path(folder), files[2])
    print("\n".join(problems) if problems else f"{count} frames equal")
    return 1 if problems else 0


if __name__ == "__main__":
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
