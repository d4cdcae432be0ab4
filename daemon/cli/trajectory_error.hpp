// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "daemon/cli/trajectory_writer.hpp"

namespace glint::cli {

/// How far an estimated trajectory is from the truth.
struct TrajectoryError {
  double ate_rmse_m = 0.0;  ///< Position, after rigid alignment without scale.
  double ate_max_m = 0.0;
  double path_m = 0.0;  ///< Length of the true path.
  std::size_t poses = 0;
};

/// Reads a TUM file; lines that start with # are skipped. @throws InputError naming file and line.
std::vector<StampedPose> read_tum(const std::filesystem::path& file);

/// Compares positions at the estimate's times, the truth interpolated between its poses and held
/// for up to 0.15 s beyond its ends. Null with fewer than three common poses.
std::optional<TrajectoryError> trajectory_error(std::span<const StampedPose> estimate,
                                                std::span<const StampedPose> truth);

}  // namespace glint::cli
