# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""What the accuracy table measures: simulated captures (rows) and configurations (columns)."""
from __future__ import annotations

import dataclasses
import hashlib

from drop_scans import Keep, every_fifth, with_gaps


@dataclasses.dataclass(frozen=True)
class Simulation:
    """One capture: options of `glint simulate`, and which of its scans are kept."""
    options: tuple[str, ...]
    keep: Keep | None = None

    @property
    def directory(self) -> str:
        """A name that differs with any option."""
        key = hashlib.sha256("\0".join(self.options).encode()).hexdigest()[:12]
        kept = f"-{self.keep.__name__}" if self.keep else ""
        return f"{self.options[1]}-{key}{kept}"


@dataclasses.dataclass(frozen=True)
class Case:
    """A row: a world and a sensor's way through it, with any seed."""
    world: str
    seconds: float
    options: str = ""
    keep: Keep | None = None

    def simulation(self, seed: int, short: float) -> Simulation:
        """`short` scales the duration."""
        return Simulation(("--world", self.world, "--seconds", f"{self.seconds * short:g}", "--seed", str(seed),
                           *self.options.split()), self.keep)


# What `glint simulate` has by default: 64 beams, 1024 columns, 10 Hz. The first six are long enough to come back
# to their start, or to places seen before; variations of the sensor are all of the world `building`.
CASES = {
    "corridor": Case("corridor", 130),
    "building": Case("building", 240),
    "parking": Case("parking", 240),
    "stairs": Case("stairs", 200),
    "hill": Case("hill", 180),
    "street": Case("street", 220),
    "tunnel 2 m/s": Case("tunnel", 68, "--speed 2"),
    "tunnel 8 m/s": Case("tunnel", 40, "--speed 8 --rate 20 --motion vehicle"),
    "tunnel-square": Case("tunnel-square", 60, "--speed 2"),
    "tunnel-bare": Case("tunnel-bare", 30, "--speed 2"),
    "plain-hall": Case("plain-hall", 60, "--beams 32 --columns 512"),
    "plain-hall handheld": Case("plain-hall", 60, "--motion handheld"),
    "plain-corridor": Case("plain-corridor", 40),
    "corridor handheld": Case("corridor", 60, "--motion handheld"),
    "building handheld": Case("building", 120, "--motion handheld"),
    "wide": Case("building", 120, "--motion handheld", every_fifth),
    "gaps": Case("building", 240, keep=with_gaps),
    "loss": Case("building", 240, "--loss 0.02"),
    "os0 128": Case("building", 120, "--sensor os0 --beams 128"),
    "os2 street": Case("street", 220, "--sensor os2"),
    "16 beams": Case("building", 120, "--beams 16"),
    "2048 columns": Case("building", 120, "--columns 2048"),
    "512x20": Case("building", 120, "--columns 512 --rate 20"),
}

# Elements of `slam` that are switched off one at a time: boolean keys, or KEY=VALUE of what stands in for them.
SWITCHES = ["image_filter", "patches", "ba_by_noise", "deskew", "gyro", "ground", "degeneracy", "moving_objects", "plane_map=tree",
            "intensity"]


@dataclasses.dataclass(frozen=True)
class Variant:
    """A column: a preset, possibly with one element of the method switched off."""
    name: str
    arguments: tuple[str, ...]


PRESETS = [Variant(preset, ("--preset", preset)) for preset in ("paper", "full")]


def without(switch: str) -> Variant:
    """`full` less one element."""
    setting = switch if "=" in switch else f"{switch}=false"
    return Variant(f"-{switch}", ("--preset", "full", "--set", f"slam.{setting}"))
