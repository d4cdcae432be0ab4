#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""Tests of the accuracy table: its measures on errors that are known, what it drops from captures, a small table.

usage: accuracy_table_test.py GLINT
"""
from __future__ import annotations

import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import trajectory_metrics as metrics
from accuracy_cases import CASES
from accuracy_table import cell
from drop_scans import drop_scans, every_fifth, with_gaps

LIDAR_PORT, IMU_PORT = 7502, 7503
SPEED_MPS = 1.5


def true_rows(x_m: np.ndarray, yaw_rad: float = 0.7) -> np.ndarray:
    """The truth along the x axis, every 10 ms; the sensor looks aside by `yaw_rad`."""
    nothing, all_of_it = np.zeros(len(x_m)), np.ones(len(x_m))
    return np.column_stack([1000 + 0.01 * np.arange(len(x_m)), x_m, nothing, nothing, nothing, nothing,
                            math.sin(yaw_rad / 2) * all_of_it, math.cos(yaw_rad / 2) * all_of_it])


def straight_on(seconds: float = 40.0) -> np.ndarray:
    return true_rows(SPEED_MPS * np.arange(0, seconds, 0.01))


def there_and_back() -> np.ndarray:
    """Turns after 20 s, is back after 40 s, and goes on."""
    way_m = SPEED_MPS * np.arange(0, 50, 0.01)
    return true_rows(30.0 - np.abs(way_m - 30.0))


def scans_of(truth: np.ndarray, axis: list[float] | None = None) -> metrics.TrueScans:
    starts_s = truth[:-10:10, 0]
    return metrics.TrueScans(starts_s, [np.reshape(axis or [], (-1, 3))] * len(starts_s))


def scan_ends(truth: np.ndarray) -> metrics.Trajectory:
    """A perfect estimate."""
    return metrics.truth_at(truth, scans_of(truth).starts_s + 0.0999)


def moved(estimate: metrics.Trajectory, positions_m: np.ndarray) -> metrics.Trajectory:
    return metrics.Trajectory(estimate.times_s, positions_m, estimate.rotations)


class Measures(unittest.TestCase):
    def test_rigid_motion_of_the_whole_is_no_error(self) -> None:
        truth = there_and_back()
        estimate = scan_ends(truth)
        R = metrics.rotations_of(np.array([[0.1, 0.5, -0.1, 0.854]]) / np.linalg.norm([0.1, 0.5, -0.1, 0.854]))[0]
        estimate = metrics.Trajectory(estimate.times_s, estimate.positions_m @ R.T + [3, -8, 2], R @ estimate.rotations)
        measures = metrics.evaluate(estimate, truth, scans_of(truth))
        for name in ("ate_m", "relative_1s_m", "relative_10m_pct", "closing_m"):
            self.assertLess(measures[name], 1e-6, name)
        self.assertAlmostEqual(measures["path_m"], 75, delta=0.5)

    def test_wrong_scale_is_not_aligned_away(self) -> None:
        truth = straight_on()
        estimate = scan_ends(truth)
        measures = metrics.evaluate(moved(estimate, 1.02 * estimate.positions_m), truth, scans_of(truth))
        self.assertAlmostEqual(measures["relative_10m_pct"], 2.0, delta=0.01)
        self.assertAlmostEqual(measures["relative_1s_m"], 0.02 * SPEED_MPS, delta=1e-4)
        # The error of the aligned path is spread evenly from -1 % to 1 % of its length.
        self.assertAlmostEqual(measures["ate_pct"], 2.0 / math.sqrt(12), delta=0.01)
        self.assertNotIn("closing_m", measures)

    def test_closing_error_is_what_drifted_until_the_return(self) -> None:
        truth = there_and_back()
        estimate = scan_ends(truth)
        share = (estimate.times_s - estimate.times_s[0]) / 40
        drifted = estimate.positions_m + share[:, None] * [0.0, 0.0, 0.4]
        measures = metrics.evaluate(moved(estimate, drifted), truth, scans_of(truth))
        self.assertAlmostEqual(measures["closing_m"], 0.4, delta=0.01)

    def test_turned_sensor_counts_in_relative_errors(self) -> None:
        truth = straight_on()
        estimate = scan_ends(truth)
        turned = metrics.rotations_of(np.array([[0.0, 0.0, math.sin(0.01), math.cos(0.01)]]))
        measures = metrics.evaluate(metrics.Trajectory(estimate.times_s, estimate.positions_m,
                                                       estimate.rotations @ turned), truth, scans_of(truth))
        self.assertLess(measures["ate_m"], 1e-6)
        self.assertAlmostEqual(measures["relative_10m_pct"], 2.0, delta=0.01)

    def test_only_errors_along_blind_axes_count_there(self) -> None:
        truth = straight_on()
        estimate = scan_ends(truth)
        short = moved(estimate, estimate.positions_m * [0.9, 1, 1])
        along = [math.cos(-0.7), math.sin(-0.7), 0.0]  # The world's x axis, seen by the sensor.
        across = [-math.sin(-0.7), math.cos(-0.7), 0.0]
        blind = metrics.evaluate(short, truth, scans_of(truth, along))
        self.assertAlmostEqual(blind["blind_1s_m"], 0.1 * SPEED_MPS, delta=1e-3)
        self.assertAlmostEqual(blind["blind_ate_m"], blind["ate_m"], delta=1e-3)
        seen = metrics.evaluate(short, truth, scans_of(truth, across))
        self.assertLess(max(seen["blind_1s_m"], seen["blind_ate_m"]), 1e-6)
        self.assertNotIn("blind_1s_m", metrics.evaluate(short, truth, scans_of(truth)))

    def test_coverage_counts_scans_once(self) -> None:
        truth = straight_on()
        estimate = scan_ends(truth)
        scans = scans_of(truth)
        self.assertEqual(metrics.coverage(estimate, scans, 0.1), 1.0)
        every_other = estimate[np.arange(0, len(estimate), 2)]
        self.assertAlmostEqual(metrics.coverage(every_other, scans, 0.1), 0.5, delta=0.01)
        self.assertEqual(metrics.coverage(estimate[np.zeros(5, int)], scans, 0.1), 1 / len(scans.starts_s))
        self.assertEqual(metrics.coverage(estimate[np.arange(0)], scans, 0.1), 0.0)
        self.assertEqual(metrics.evaluate(estimate[np.arange(0)], truth, scans), {})

    def test_nees_of_right_covariances_is_their_dimension(self) -> None:
        random = np.random.default_rng(1)
        root = random.normal(size=(6, 6))
        errors = random.normal(size=(20000, 6)) @ root.T
        covariances = np.broadcast_to(root @ root.T, (len(errors), 6, 6))
        self.assertAlmostEqual(metrics.nees(errors, covariances).mean(), 6.0, delta=0.1)
        self.assertAlmostEqual(metrics.nees(errors, covariances / 4).mean(), 24.0, delta=0.4)

    def test_consistency_of_a_walk_whose_steps_err_as_told(self) -> None:
        random = np.random.default_rng(2)
        truth = straight_on()
        true = metrics.trajectory_of(truth)
        sigma = 0.01
        steps = random.normal(scale=sigma, size=true.positions_m.shape)
        walk = metrics.Trajectory(true.times_s, true.positions_m + np.cumsum(steps, axis=0), true.rotations)
        # Only the positions' three of six err.
        covariances = {time_s: np.diag([sigma**2] * 3 + [1e-14] * 3) * (k + 1)
                       for k, time_s in enumerate(true.times_s)}
        found = metrics.consistency(walk, truth, covariances)
        self.assertAlmostEqual(found["nees_1s"], 0.5, delta=0.15)
        halved = metrics.consistency(walk, truth, {t: c / 2 for t, c in covariances.items()})
        self.assertAlmostEqual(halved["nees_1s"] / found["nees_1s"], 2.0, delta=0.01)

    def test_covariances_are_read_from_the_scan_table(self) -> None:
        axes = ("x", "y", "z", "rx", "ry", "rz")
        names = [f"cov_{a}_{b}" for k, a in enumerate(axes) for b in axes[k:]]
        with tempfile.TemporaryDirectory() as directory:
            file = pathlib.Path(directory) / "scans.csv"
            file.write_text(",".join(["t", "state", *names]) + "\n" +
                            ",".join(["12.5", "TRACKING", *(str(k) for k in range(21))]) + "\n")
            covariance = metrics.read_covariances(file)[12.5]
        self.assertEqual(covariance[0, 5], 5)
        self.assertEqual(covariance[5, 0], 5)
        self.assertEqual(covariance[1, 1], 6)
        self.assertEqual(covariance[5, 5], 20)


def record(port: int, payload: bytes) -> bytes:
    udp = struct.pack(">HHHH", port, port, 8 + len(payload), 0) + payload
    ip = struct.pack(">BBHHHBBHII", 0x45, 0, 20 + len(udp), 0, 0, 64, 17, 0, 0x7F000001, 0x7F000001) + udp
    frame = bytes(12) + b"\x08\x00" + ip
    return struct.pack("<IIII", 0, 0, len(frame), len(frame)) + frame


def small_simulation(directory: pathlib.Path, frame_ids: list[int]) -> None:
    """Two lidar packets and one IMU packet for each scan."""
    directory.mkdir()
    packets = [record(LIDAR_PORT, struct.pack("<HHB", 1, frame_id, part)) if part < 2 else
               record(IMU_PORT, struct.pack("<HHB", 1, frame_id, part))
               for frame_id in frame_ids for part in range(3)]
    header = struct.pack("<IHHIIII", 0xA1B23C4D, 2, 4, 0, 0, 65536, 1)
    (directory / "capture.pcap").write_bytes(header + b"".join(packets))
    (directory / "metadata.json").write_text(json.dumps(
        {"config_params": {"udp_port_lidar": LIDAR_PORT}, "lidar_data_format": {"fps": 10.0}}))
    (directory / "groundtruth_100hz.tum").write_text("")
    (directory / "truth.jsonl").write_text("".join(f'{{"scan":{scan}}}\n' for scan in range(len(frame_ids))))


def packets_in(capture: pathlib.Path) -> list[tuple[int, int, int]]:
    """Port, frame id and part of each."""
    rest, packets = capture.read_bytes()[24:], []
    while rest:
        size = 16 + struct.unpack_from("<I", rest, 8)[0]
        packets.append((struct.unpack_from(">H", rest, 16 + 36)[0], *struct.unpack_from("<HB", rest, 16 + 44)))
        rest = rest[size:]
    return packets


class DroppedScans(unittest.TestCase):
    def setUp(self) -> None:
        directory = tempfile.TemporaryDirectory(prefix="glint-accuracy-")
        self.addCleanup(directory.cleanup)
        self.at = pathlib.Path(directory.name)

    def test_every_fifth_scan_is_kept_over_the_wrap_and_all_imu_packets(self) -> None:
        frame_ids = [(65530 + scan) % 65536 for scan in range(20)]
        small_simulation(self.at / "whole", frame_ids)
        drop_scans(self.at / "whole", self.at / "wide", every_fifth)
        packets = packets_in(self.at / "wide" / "capture.pcap")
        kept = [frame_ids[scan] for scan in (0, 5, 10, 15)]
        self.assertEqual([packet for packet in packets if packet[0] == LIDAR_PORT],
                         [(LIDAR_PORT, frame_id, part) for frame_id in kept for part in (0, 1)])
        self.assertEqual([frame_id for port, frame_id, _ in packets if port == IMU_PORT], frame_ids)
        lines = (self.at / "wide" / "truth.jsonl").read_text().splitlines()
        self.assertEqual([json.loads(line)["scan"] for line in lines], [0, 5, 10, 15])

    def test_late_packet_belongs_to_its_own_scan(self) -> None:
        small_simulation(self.at / "whole", [1, 2, 3, 4, 5, 4, 6, 7])
        drop_scans(self.at / "whole", self.at / "wide", every_fifth)
        lidar = [frame_id for port, frame_id, _ in packets_in(self.at / "wide" / "capture.pcap") if port == LIDAR_PORT]
        self.assertEqual(lidar, [1, 1, 6, 6])

    def test_gaps_last_three_tenths_of_a_second(self) -> None:
        self.assertEqual([scan for scan in range(100) if not with_gaps(scan, 0.1)], [25, 26, 27, 75, 76, 77])
        self.assertEqual([scan for scan in range(100) if not with_gaps(scan, 0.05)], list(range(50, 56)))

    def test_other_files_are_refused(self) -> None:
        small_simulation(self.at / "whole", [1])
        (self.at / "whole" / "capture.pcap").write_bytes(bytes(100))
        with self.assertRaises(ValueError):
            drop_scans(self.at / "whole", self.at / "wide", every_fifth)


class Table(unittest.TestCase):
    glint = ""

    def test_cell_has_the_mean_and_each_seed(self) -> None:
        self.assertEqual(cell([1.0], 2), "1.00")
        self.assertEqual(cell([1.0, 2.0], 1), "1.5 (1.0, 2.0)")
        self.assertEqual(cell([None, 2.0], 1), "2.0 (-, 2.0)")
        self.assertEqual(cell([None, None], 1), "-")

    def test_each_capture_has_its_own_directory(self) -> None:
        names = {case.simulation(seed, short).directory
                 for case in CASES.values() for seed in (1, 2) for short in (1.0, 0.5)}
        self.assertEqual(len(names), 4 * len(CASES))

    def test_short_table_is_made_once(self) -> None:
        table = [sys.executable, pathlib.Path(__file__).with_name("accuracy_table.py"), self.glint]
        options = ["--cases", "plain-hall", "--seeds", "1", "--short", "0.05", "--without", "ground", "no_such_key"]
        with tempfile.TemporaryDirectory(prefix="glint-accuracy-") as work:
            first = subprocess.run([*table, work, *options, "--discard"], capture_output=True, text=True, check=True)
            self.assertIn("| | paper | full | -ground |\n", first.stdout)
            self.assertIn("skipped: -no_such_key", first.stderr)
            self.assertEqual(first.stderr.count("done: plain-hall, seed 1"), 3)
            self.assertEqual(list(pathlib.Path(work, "captures").iterdir()), [])
            results = pathlib.Path(work, "results.jsonl").read_text()
            measures = [json.loads(line)["measures"] for line in results.splitlines()]
            self.assertEqual(len(measures), 3)
            for each in measures:
                self.assertLess(each["map.ate_m"], 0.2)
                self.assertGreater(each["coverage_pct"], 90)
            second = subprocess.run([*table, work, *options], capture_output=True, text=True, check=True)
            self.assertEqual(second.stdout, first.stdout)
            self.assertNotIn("done:", second.stderr)


if __name__ == "__main__":
    Table.glint = sys.argv.pop(1)
    unittest.main()
