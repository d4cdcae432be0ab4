// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <functional>

#include "pcap/synth/network_faults.hpp"
#include "pcap/synth/simulation_options.hpp"

namespace glint::synth {

/// Writes into a directory, which is made if need be:
///   capture.pcap           what arrived from the sensor; datagrams larger than `mtu` in fragments,
///                          if that is not 0
///   metadata.json          what it says of itself
///   groundtruth.tum        T_world_sensor at each scan's first column: t x y z qx qy qz qw
///   groundtruth_100hz.tum  the same every 10 ms
///   truth.jsonl            a line a scan: scan, frame_id, t_ns, t, blind_axes (unit vectors in the
///                          sensor frame), moving_share, moving_pixels: runs [row, first column,
///                          last column] (staggered) on moving things, earlier_scans_within_2m:
///                          runs [first, last] of `scan` that are at least 10 m of way older
/// Times are sensor times. The files get their names at the end, the capture last: what stops
/// half-way leaves nothing that looks whole. `progress(done, all)` follows the scans.
/// @throws InputError if something cannot be written, OptionError as Simulator does.
FaultCounts simulate(const SimulationOptions& options, const std::filesystem::path& directory,
                     int mtu = 0, const std::function<void(int done, int all)>& progress = {});

}  // namespace glint::synth
