// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>

#include "pcap/synth/motion/motion.hpp"

namespace glint::synth {

struct TrajectoryFile {
  Motion motion;            ///< Starts with the first pose, stays at the last.
  double duration_s = 0.0;  ///< From the first pose to the last.
};

/// Reads T_world_sensor from a TUM file ("t x y z qx qy qz qw" a line, times rising) or a KITTI
/// file (3x4 matrix, row by row, a line; poses `1 / rate_hz` apart). The motion goes through every
/// pose, by cubic splines. @throws InputError that names file, line and cause.
TrajectoryFile load_trajectory(const std::filesystem::path& file, double rate_hz);

}  // namespace glint::synth
