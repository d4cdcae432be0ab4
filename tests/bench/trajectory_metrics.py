# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""How far an estimated trajectory is from the true one.

Poses are of the sensor in a fixed frame, times in seconds, lengths in metres. Measures:
  ate_m             position error, RMSE after rigid alignment without scale; ate_pct: as % of the true path
  relative_1s_m     error of the motion over 1 s, RMSE of its length
  relative_10m_pct  error of the motion over 10 m of true path, mean of its length as % of the path
  closing_m         error of the motion from the first pose to the return to it, where there is one
  blind_ate_m, blind_1s_m
                    the parts of ate_m and relative_1s_m along the axes that geometry says nothing of
  nees_1s, nees_10m normalised squared error of the odometry's motions over 1 s and 10 m, divided by 6
"""
from __future__ import annotations

import csv
import dataclasses
import json
import pathlib

import numpy as np

# Points of the true path whose distances add up to its length: the sway of a gait is no distance.
PATH_STEP_S = 0.2
# The truth is held still for so long beyond its ends, for the stamp at the end of the last scan.
TRUTH_MARGIN_S = 0.15
# Two motions are compared if theirs differs from the wanted time or length by no more than this share.
PAIR_SLACK = 0.07
# A return: so near the first pose again, having been so far away.
RETURN_M = 1.0
AWAY_M = 5.0


@dataclasses.dataclass(frozen=True)
class Trajectory:
    """Poses by rising time."""
    times_s: np.ndarray  # (n,)
    positions_m: np.ndarray  # (n, 3)
    rotations: np.ndarray  # (n, 3, 3), of T_world_sensor

    def __len__(self) -> int:
        return len(self.times_s)

    def __getitem__(self, rows: np.ndarray) -> Trajectory:
        return Trajectory(self.times_s[rows], self.positions_m[rows], self.rotations[rows])


@dataclasses.dataclass(frozen=True)
class TrueScans:
    """What the simulator tells of each scan of a capture."""
    starts_s: np.ndarray  # (n,), time of the first column
    blind_axes: list[np.ndarray]  # n times (axes, 3): unit vectors in the sensor frame at the start


def rotations_of(quaternions: np.ndarray) -> np.ndarray:
    """(n, 4) unit quaternions x y z w to (n, 3, 3) matrices."""
    x, y, z, w = quaternions.T
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), 2, 0)


def read_tum(file: pathlib.Path) -> np.ndarray:
    """(n, 8): time, position and quaternion x y z w of each line."""
    lines = [line.split() for line in file.read_text().splitlines() if line and not line.startswith("#")]
    rows = np.array(lines, float).reshape(-1, 8)
    rows[:, 4:] /= np.linalg.norm(rows[:, 4:], axis=1, keepdims=True)
    return rows


def trajectory_of(rows: np.ndarray) -> Trajectory:
    """Poses of the rows that read_tum() gives."""
    return Trajectory(rows[:, 0], rows[:, 1:4], rotations_of(rows[:, 4:]))


def read_true_scans(file: pathlib.Path) -> TrueScans:
    """The truth.jsonl that `glint simulate` writes."""
    scans = [json.loads(line) for line in file.read_text().splitlines()]
    return TrueScans(np.array([scan["t_ns"] * 1e-9 for scan in scans]),
                     [np.array(scan["blind_axes"]).reshape(-1, 3) for scan in scans])


def truth_at(truth: np.ndarray, times_s: np.ndarray) -> Trajectory:
    """True poses at any times; `truth` as read_tum() gives it, held still beyond its ends."""
    times_s = np.clip(times_s, truth[0, 0], truth[-1, 0])
    after = np.clip(np.searchsorted(truth[:, 0], times_s, side="right"), 1, len(truth) - 1)
    a, b = truth[after - 1], truth[after].copy()
    share = ((times_s - a[:, 0]) / (b[:, 0] - a[:, 0]))[:, None]
    b[:, 4:] *= np.where(np.sum(a[:, 4:] * b[:, 4:], axis=1, keepdims=True) < 0, -1, 1)
    # Quaternions 10 ms apart are so near each other that the chord serves for the arc.
    rows = (1 - share) * a + share * b
    rows[:, 4:] /= np.linalg.norm(rows[:, 4:], axis=1, keepdims=True)
    return Trajectory(times_s, rows[:, 1:4], rotations_of(rows[:, 4:]))


def aligned(points: np.ndarray, onto: np.ndarray) -> np.ndarray:
    """The points after the rigid motion that brings them nearest to `onto` (Kabsch)."""
    middle, onto_middle = points.mean(axis=0), onto.mean(axis=0)
    u, _, vt = np.linalg.svd((onto - onto_middle).T @ (points - middle))
    mirrored = np.sign(np.linalg.det(u @ vt))
    return (points - middle) @ (u @ np.diag([1.0, 1.0, mirrored]) @ vt).T + onto_middle


def path_at(truth: np.ndarray, times_s: np.ndarray) -> np.ndarray:
    """Length of the true path from its start to each time."""
    step = max(1, round(PATH_STEP_S / float(np.median(np.diff(truth[:, 0])))))
    coarse = truth[::step]
    steps_m = np.linalg.norm(np.diff(coarse[:, 1:4], axis=0), axis=1)
    return np.interp(times_s, coarse[:, 0], np.concatenate([[0.0], np.cumsum(steps_m)]))


def pairs(x: np.ndarray, distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Indices i < j with x[j] nearest to x[i] + distance; x does not fall."""
    i = np.arange(len(x))
    j = np.clip(np.searchsorted(x, x + distance), 1, len(x) - 1)
    j -= np.abs(x[j - 1] - x - distance) < np.abs(x[j] - x - distance)
    good = (np.abs(x[j] - x - distance) <= PAIR_SLACK * distance) & (j > i)
    return i[good], j[good]


def motion_errors(estimate: Trajectory, true: Trajectory, i: np.ndarray, j: np.ndarray) -> np.ndarray:
    """(pairs, 3): where j is seen from i, estimated minus true, in the sensor frame of i."""
    def seen(of: Trajectory) -> np.ndarray:
        return np.einsum("nji,nj->ni", of.rotations[i], of.positions_m[j] - of.positions_m[i])
    return seen(estimate) - seen(true)


def closing_error(estimate: Trajectory, true: Trajectory) -> float | None:
    """Error of the motion from the first pose to the return; None where the path does not return."""
    away_m = np.linalg.norm(true.positions_m - true.positions_m[0], axis=1)
    if away_m.max() < AWAY_M:
        return None
    left = int(np.argmax(away_m >= AWAY_M))
    back = left + int(np.argmin(away_m[left:]))
    if away_m[back] > RETURN_M:
        return None
    return float(np.linalg.norm(motion_errors(estimate, true, np.array([0]), np.array([back]))))


def rms(vectors: np.ndarray) -> float:
    """Root of the mean squared length of (n, k)."""
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1))))


def blind_errors(true: Trajectory, truth: np.ndarray, scans: TrueScans, errors_m: np.ndarray,
                 i: np.ndarray, motion_errors_m: np.ndarray) -> dict[str, float]:
    """Errors along the blind axes, of the poses whose scan has any."""
    scan = np.searchsorted(scans.starts_s, true.times_s) - 1
    at_start = truth_at(truth, scans.starts_s)
    axes = {pose: scans.blind_axes[k] @ at_start.rotations[k].T  # In the world frame.
            for pose, k in enumerate(scan) if k >= 0 and len(scans.blind_axes[k]) > 0}
    absolute = [np.sum((axes[pose] @ errors_m[pose]) ** 2) for pose in axes]
    relative = [np.sum((axes[pose] @ true.rotations[pose] @ error) ** 2)
                for pose, error in zip(i, motion_errors_m) if pose in axes]
    measures = {"blind_ate_m": absolute, "blind_1s_m": relative}
    return {name: float(np.sqrt(np.mean(squares))) for name, squares in measures.items() if squares}


def evaluate(estimate: Trajectory, truth: np.ndarray, scans: TrueScans) -> dict[str, float]:
    """The measures named at the top; those that a trajectory is too short for are left out."""
    estimate = estimate[(estimate.times_s >= truth[0, 0] - TRUTH_MARGIN_S) &
                        (estimate.times_s <= truth[-1, 0] + TRUTH_MARGIN_S)]
    if len(estimate) < 3:
        return {}
    times_s = estimate.times_s
    true = truth_at(truth, times_s)
    errors_m = aligned(estimate.positions_m, true.positions_m) - true.positions_m
    measures = {"path_m": float(path_at(truth, truth[-1:, 0])[0]), "ate_m": rms(errors_m)}
    if measures["path_m"] > 0:
        measures["ate_pct"] = 100 * measures["ate_m"] / measures["path_m"]

    i, j = pairs(times_s, 1.0)
    over_1s_m = motion_errors(estimate, true, i, j)
    if len(i) > 0:
        measures["relative_1s_m"] = rms(over_1s_m)
    measures |= blind_errors(true, truth, scans, errors_m, i, over_1s_m)

    path_m = path_at(truth, times_s)
    i, j = pairs(path_m, 10.0)
    if len(i) > 0:
        shares = np.linalg.norm(motion_errors(estimate, true, i, j), axis=1) / (path_m[j] - path_m[i])
        measures["relative_10m_pct"] = 100 * float(np.mean(shares))

    closing_m = closing_error(estimate, true)
    return measures if closing_m is None else measures | {"closing_m": closing_m}


def coverage(estimate: Trajectory, scans: TrueScans, period_s: float) -> float:
    """Share of the scans with a pose stamped from their start to their end."""
    scan = np.searchsorted(scans.starts_s, estimate.times_s) - 1
    inside = (scan >= 0) & (estimate.times_s <= scans.starts_s[scan] + 1.02 * period_s)
    return len(np.unique(scan[inside])) / len(scans.starts_s)


def nees(errors: np.ndarray, covariances: np.ndarray) -> np.ndarray:
    """(n, k) errors and (n, k, k) covariances to (n,) normalised squared errors: k in the mean where the
    covariances are right, more where they are too small."""
    return np.einsum("ni,ni->n", errors, np.linalg.solve(covariances, errors[:, :, None])[:, :, 0])


def read_covariances(file: pathlib.Path) -> dict[float, np.ndarray]:
    """Time to 6x6 covariance of the odometry, from the scans.csv that `glint replay` writes."""
    upper = np.triu_indices(6)
    covariances = {}
    with open(file, newline="") as table:
        for row in csv.DictReader(table):
            covariance = np.zeros((6, 6))
            covariance[upper] = [float(value) for name, value in row.items() if name.startswith("cov_")]
            covariances[float(row["t"])] = covariance + np.triu(covariance, 1).T
    return covariances


def rotation_vectors(rotations: np.ndarray) -> np.ndarray:
    """(n, 3, 3) small rotations to (n, 3), rad."""
    skew = rotations - np.swapaxes(rotations, 1, 2)
    return 0.5 * np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1)


def motion_nees(estimate: Trajectory, true: Trajectory, covariances: np.ndarray, i: np.ndarray,
                j: np.ndarray) -> np.ndarray:
    """NEES of the motions from i to j: what the covariance gained on the way, against the error, both in the
    sensor frame of j (right perturbation, translation first)."""
    def motion(of: Trajectory) -> tuple[np.ndarray, np.ndarray]:
        back = np.swapaxes(of.rotations[i], 1, 2)
        return (np.einsum("nij,nj->ni", back, of.positions_m[j] - of.positions_m[i]), back @ of.rotations[j])
    (way, turn), (true_way, true_turn) = motion(estimate), motion(true)
    back = np.swapaxes(turn, 1, 2)
    errors = np.concatenate([np.einsum("nij,nj->ni", back, true_way - way), rotation_vectors(back @ true_turn)], axis=1)
    carried = np.zeros((len(i), 6, 6))  # The adjoint of the motion's inverse.
    offset = -np.einsum("nij,nj->ni", back, way)
    x, y, z = offset.T
    zero = np.zeros_like(x)
    cross = np.moveaxis(np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]), 2, 0)
    carried[:, :3, :3] = carried[:, 3:, 3:] = back
    carried[:, :3, 3:] = cross @ back
    gained = covariances[j] - carried @ covariances[i] @ np.swapaxes(carried, 1, 2)
    return nees(errors, gained)


def consistency(odometry: Trajectory, truth: np.ndarray, covariances: dict[float, np.ndarray]) -> dict[str, float]:
    """NEES / 6 of the odometry's motions over 1 s and over 10 m of path, in the mean."""
    odometry = odometry[(odometry.times_s >= truth[0, 0]) & (odometry.times_s <= truth[-1, 0])]
    if len(odometry) < 3:
        return {}
    of_poses = np.array([covariances[time_s] for time_s in odometry.times_s])
    true = truth_at(truth, odometry.times_s)
    measures = {}
    for name, x, distance in (("nees_1s", odometry.times_s, 1.0), ("nees_10m", path_at(truth, odometry.times_s), 10.0)):
        i, j = pairs(x, distance)
        if len(i) > 0:
            measures[name] = float(np.mean(motion_nees(odometry, true, of_poses, i, j))) / 6
    return measures
