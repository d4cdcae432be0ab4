#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""Measures accuracy in simulated worlds: a Markdown table per measure, a row a case, a column a variant.

Simulates each case (accuracy_cases.py) with each seed, replays it with the presets and with `full` less one element
at a time, and evaluates the trajectories against the truth (trajectory_metrics.py says how). What is in WORK from
an earlier call is used again: captures, whose names follow from their options, and results. A capture takes some
8 MB per second of it; --discard removes each after its replays. Cells are means over the seeds, then the seeds' own.
"""
from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import hashlib
import json
import pathlib
import shutil
import subprocess
import sys

import numpy as np

from accuracy_cases import CASES, PRESETS, SWITCHES, Simulation, Variant, without
from drop_scans import drop_scans
from trajectory_metrics import (consistency, coverage, evaluate, read_covariances, read_true_scans, read_tum,
                                trajectory_of)

# Files of a replay that are large and not evaluated.
BULKY = ["map.ply", "session.glint"]

# Title and decimals of each measure. `map` is the trajectory as the back end leaves it, `odometry` as told live.
TABLES = {
    "map.ate_m": ("ATE, map, m", 3),
    "map.ate_pct": ("ATE, map, % of the path", 2),
    "odometry.ate_m": ("ATE, odometry, m", 3),
    "odometry.ate_pct": ("ATE, odometry, % of the path", 2),
    "odometry.relative_1s_m": ("Relative error over 1 s, odometry, m", 4),
    "odometry.relative_10m_pct": ("Relative error over 10 m, odometry, %", 2),
    "map.relative_10m_pct": ("Relative error over 10 m, map, %", 2),
    "odometry.closing_m": ("Closing error at the return to the start, odometry, m", 3),
    "map.closing_m": ("Closing error at the return to the start, map, m", 3),
    "odometry.blind_ate_m": ("ATE along the blind axes, odometry, m", 3),
    "odometry.blind_1s_m": ("Relative error over 1 s along the blind axes, odometry, m", 4),
    "nees_1s": ("NEES / 6 of the odometry over 1 s (1 if the covariances are right)", 2),
    "nees_10m": ("NEES / 6 of the odometry over 10 m (1 if the covariances are right)", 2),
    "coverage_pct": ("Scans with a pose, %", 1),
    "lost_s": ("Time in state LOST, s", 1),
    "degenerate_s": ("Time degenerate, s", 1),
    "cpu_p50_ms": ("CPU time a scan, median, ms", 1),
    "cpu_p99_ms": ("CPU time a scan, 99th percentile, ms", 1),
    "peak_rss_mb": ("Peak memory, MB", 0),
}


@dataclasses.dataclass(frozen=True)
class Task:
    """A cell and a seed of it."""
    case: str
    seed: int
    simulation: Simulation
    variant: Variant

    @property
    def key(self) -> tuple[str, str]:
        return self.simulation.directory, self.variant.name


class Results:
    """The measures of all tasks done, in a file of one JSON object a line, of which the last of a key counts."""

    def __init__(self, file: pathlib.Path, glint: pathlib.Path) -> None:
        self.file = file
        self.build = hashlib.sha256(glint.read_bytes()).hexdigest()[:12]
        lines = file.read_text().splitlines() if file.exists() else []
        self.by_key = {(result["capture"], result["variant"]): result for result in map(json.loads, lines)}

    def add(self, task: Task, measures: dict[str, float]) -> None:
        capture, variant = task.key
        result = {"case": task.case, "seed": task.seed, "capture": capture, "variant": variant, "build": self.build,
                  "measures": measures}
        self.by_key[task.key] = result
        with open(self.file, "a", encoding="utf-8") as lines:
            lines.write(json.dumps(result) + "\n")

    def measure(self, task: Task, name: str) -> float | None:
        return self.by_key[task.key]["measures"].get(name) if task.key in self.by_key else None

    def of_other_builds(self, tasks: list[Task]) -> int:
        return sum(self.by_key[task.key]["build"] != self.build for task in tasks if task.key in self.by_key)


def known_variants(glint: pathlib.Path, variants: list[Variant], work: pathlib.Path) -> list[Variant]:
    """Those whose keys this glint has; says which it does not have."""
    known = []
    for variant in variants:
        # The settings are read before the capture, which is none.
        probe = subprocess.run([glint, "replay", work / "none.pcap", "--out", work / "none", *variant.arguments],
                               capture_output=True, text=True, check=False)
        if "unknown key" in probe.stderr:
            print(f"skipped: {variant.name}: this glint has no key {variant.arguments[-1].split('=')[0]}",
                  file=sys.stderr)
        else:
            known.append(variant)
    return known


def capture_of(glint: pathlib.Path, simulation: Simulation, captures: pathlib.Path, threads: int) -> pathlib.Path:
    """Directory of the capture, which is made unless it is there."""
    directory = captures / simulation.directory
    if directory.exists():
        return directory
    partial = directory.with_suffix(".partial")
    shutil.rmtree(partial, ignore_errors=True)
    if simulation.keep:
        whole = capture_of(glint, Simulation(simulation.options), captures, threads)
        drop_scans(whole, partial, simulation.keep)
    else:
        subprocess.run([glint, "simulate", *simulation.options, "--threads", str(threads), "--out", partial],
                       check=True, stdout=subprocess.DEVNULL)
    partial.rename(directory)
    return directory


def discard(simulation: Simulation, captures: pathlib.Path) -> None:
    """Removes a capture and the one that it was made from."""
    for unwanted in (simulation, Simulation(simulation.options)):
        shutil.rmtree(captures / unwanted.directory, ignore_errors=True)


def measures_of(run: pathlib.Path, capture: pathlib.Path) -> dict[str, float]:
    """All measures of one replay, named as in TABLES."""
    truth = read_tum(capture / "groundtruth_100hz.tum")
    scans = read_true_scans(capture / "truth.jsonl")
    fps = json.loads((capture / "metadata.json").read_text())["lidar_data_format"]["fps"]
    summary = json.loads((run / "summary.json").read_text())
    cpu_ms = summary["stage_cpu_ms"]["total"]
    measures = {name: summary[name] for name in ("lost_s", "degenerate_s", "peak_rss_mb")}
    measures |= {"cpu_p50_ms": cpu_ms["p50"], "cpu_p99_ms": cpu_ms["p99"]}
    for name, file in (("map", "trajectory.tum"), ("odometry", "odometry.tum")):
        estimate = trajectory_of(read_tum(run / file))
        measures |= {f"{name}.{measure}": value for measure, value in evaluate(estimate, truth, scans).items()}
    measures["coverage_pct"] = 100 * coverage(estimate, scans, 1 / fps)
    return measures | consistency(estimate, truth, read_covariances(run / "scans.csv"))


def replay(glint: pathlib.Path, task: Task, capture: pathlib.Path, runs: pathlib.Path) -> dict[str, float]:
    """Replays and evaluates. @raises RuntimeError with what the replay said"""
    run = runs / task.simulation.directory / task.variant.name
    done = subprocess.run([glint, "replay", capture / "capture.pcap", "--out", run, *task.variant.arguments],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"exit code {done.returncode}: {done.stderr.strip()}")
    for name in BULKY:
        (run / name).unlink(missing_ok=True)
    return measures_of(run, capture)


def run_tasks(glint: pathlib.Path, tasks: list[Task], results: Results, arguments: argparse.Namespace) -> int:
    """Does the tasks, one capture after the other; returns how many failed."""
    failures = 0
    for simulation in dict.fromkeys(task.simulation for task in tasks):
        capture = capture_of(glint, simulation, arguments.work / "captures", arguments.jobs)
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            futures = {pool.submit(replay, glint, task, capture, arguments.work / "runs"): task
                       for task in tasks if task.simulation == simulation}
            for future in concurrent.futures.as_completed(futures):
                task = futures[future]
                label = f"{task.case}, seed {task.seed}, {task.variant.name}"
                try:
                    results.add(task, future.result())
                    print(f"done: {label}", file=sys.stderr, flush=True)
                except RuntimeError as error:
                    failures += 1
                    print(f"FAILED: {label}: {error}", file=sys.stderr, flush=True)
        if arguments.discard:
            discard(simulation, arguments.work / "captures")
    return failures


def cell(values: list[float | None], decimals: int) -> str:
    """Mean and values, a dash for those that are missing."""
    there = [value for value in values if value is not None]
    if not there:
        return "-"
    mean = f"{np.mean(there):.{decimals}f}"
    each = ", ".join("-" if value is None else f"{value:.{decimals}f}" for value in values)
    return mean if len(values) == 1 else f"{mean} ({each})"


def table(name: str, tasks: list[Task], results: Results) -> str:
    """One measure; empty if no task has it. Rows without it are left out."""
    title, decimals = TABLES[name]
    variants = list(dict.fromkeys(task.variant.name for task in tasks))
    rows = []
    for case in dict.fromkeys(task.case for task in tasks):
        cells = [cell([results.measure(task, name) for task in tasks
                       if (task.case, task.variant.name) == (case, variant)], decimals) for variant in variants]
        if any(text != "-" for text in cells):
            rows.append(f"| {' | '.join([case, *cells])} |\n")
    if not rows:
        return ""
    return f"### {title}\n\n| | {' | '.join(variants)} |\n|---{'|---:' * len(variants)}|\n{''.join(rows)}\n"


def parsed_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint", type=pathlib.Path, help="the program to measure")
    parser.add_argument("work", type=pathlib.Path, help="directory for captures, replays and results.jsonl")
    parser.add_argument("--cases", nargs="+", default=list(CASES), choices=list(CASES), metavar="CASE",
                        help=f"rows (default: all): {', '.join(CASES)}")
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3], help="default: 1 2 3")
    parser.add_argument("--without", nargs="*", default=SWITCHES, metavar="SWITCH",
                        help=f"keys of slam to switch off (or KEY=VALUE), each by itself (default: {' '.join(SWITCHES)})")
    parser.add_argument("--short", type=float, default=1.0, help="factor to all durations")
    parser.add_argument("--jobs", type=int, default=1, help="replays at a time; more than one disturbs the times")
    parser.add_argument("--again", action="store_true", help="replay even what has results")
    parser.add_argument("--discard", action="store_true", help="remove each capture after its replays")
    parser.add_argument("--tables", action="store_true", help="only print what has results")
    return parser.parse_args()


def main() -> int:
    arguments = parsed_arguments()
    arguments.work.mkdir(parents=True, exist_ok=True)
    glint = arguments.glint.resolve()
    variants = known_variants(glint, PRESETS + [without(switch) for switch in arguments.without], arguments.work)
    tasks = [Task(case, seed, CASES[case].simulation(seed, arguments.short), variant)
             for case in arguments.cases for seed in arguments.seeds for variant in variants]
    results = Results(arguments.work / "results.jsonl", glint)
    failures = 0
    if not arguments.tables:
        wanted = [task for task in tasks if arguments.again or task.key not in results.by_key]
        failures = run_tasks(glint, wanted, results, arguments)
    if others := results.of_other_builds(tasks):
        print(f"note: {others} results are of other builds of glint; --again measures them anew", file=sys.stderr)
    print("".join(table(name, tasks, results) for name in TABLES), end="")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
