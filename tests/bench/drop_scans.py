# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""Copies a simulated capture without the lidar packets of some scans, as if they had never come.

Reads what `glint simulate` writes: classic pcap, little endian, Ethernet, IPv4, no fragments. Packets have
profile RNG19_RFL8_SIG16_NIR16, so the scan's frame id is the u16 at byte 2. All else, such as IMU packets,
is kept; times stay.
"""
from __future__ import annotations

import collections.abc
import json
import pathlib
import shutil
import struct
import typing

# Given the ordinal of a scan, from 0, and the scan period: is it kept?
Keep = typing.Callable[[int, float], bool]

MAGICS = {0xA1B2C3D4, 0xA1B23C4D}  # Microseconds, nanoseconds.
FILE_HEADER_BYTES = 24
RECORD_HEADER = struct.Struct("<IIII")
ETHERNET_BYTES = 14
UDP_HEADER_BYTES = 8
FRAME_ID_AT = 2


def every_fifth(scan: int, _period_s: float) -> bool:
    """2 Hz of 10 Hz."""
    return scan % 5 == 0


def with_gaps(scan: int, period_s: float) -> bool:
    """Every 5 s the scans of 0.3 s are lost; the first gap comes after 2.5 s."""
    per_cycle, lost = round(5.0 / period_s), round(0.3 / period_s)
    return not per_cycle // 2 <= scan % per_cycle < per_cycle // 2 + lost


def udp_payload(frame: bytes, port: int) -> bytes | None:
    """Payload of an IPv4 datagram to `port`; None for any other frame."""
    if frame[12:14] != b"\x08\x00" or frame[ETHERNET_BYTES + 9] != 17:
        return None
    udp_at = ETHERNET_BYTES + 4 * (frame[ETHERNET_BYTES] & 0x0F)
    if int.from_bytes(frame[udp_at + 2:udp_at + 4], "big") != port:
        return None
    return frame[udp_at + UDP_HEADER_BYTES:]


def records(capture: typing.BinaryIO) -> collections.abc.Iterator[tuple[bytes, bytes]]:
    """Header and frame of each record; stands behind the file header."""
    while len(header := capture.read(RECORD_HEADER.size)) == RECORD_HEADER.size:
        yield header, capture.read(RECORD_HEADER.unpack(header)[2])


def drop_packets(source: pathlib.Path, target: pathlib.Path, port: int,
                 is_kept: typing.Callable[[int], bool]) -> None:
    """Copies a capture without the packets to `port` of the scans that are not kept."""
    with open(source, "rb") as capture, open(target, "wb") as copy:
        file_header = capture.read(FILE_HEADER_BYTES)
        if len(file_header) < FILE_HEADER_BYTES or struct.unpack_from("<I", file_header)[0] not in MAGICS:
            raise ValueError(f"{source} is no classic little-endian pcap")
        copy.write(file_header)
        scan, last_id = 0, None
        for header, frame in records(capture):
            payload = udp_payload(frame, port)
            if payload is not None:
                frame_id = int.from_bytes(payload[FRAME_ID_AT:FRAME_ID_AT + 2], "little")
                if last_id is not None:  # Ids wrap at 16 bits, and late packets go back.
                    scan += (frame_id - last_id + 0x8000) % 0x10000 - 0x8000
                last_id = frame_id
                if not is_kept(scan):
                    continue
            copy.write(header + frame)


def drop_scans(source: pathlib.Path, target: pathlib.Path, keep: Keep) -> None:
    """Makes directory `target` of a simulation's `source`: capture and truth of the scans that are kept."""
    metadata = json.loads((source / "metadata.json").read_text())
    period_s = 1.0 / metadata["lidar_data_format"]["fps"]
    target.mkdir(parents=True, exist_ok=True)
    for name in ("metadata.json", "groundtruth_100hz.tum"):
        shutil.copy(source / name, target / name)
    drop_packets(source / "capture.pcap", target / "capture.pcap", metadata["config_params"]["udp_port_lidar"],
                 lambda scan: keep(scan, period_s))
    lines = (source / "truth.jsonl").read_text().splitlines(keepends=True)
    (target / "truth.jsonl").write_text("".join(line for line in lines if keep(json.loads(line)["scan"], period_s)))
