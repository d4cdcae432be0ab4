// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "driver/core/pose.hpp"
#include "slam/gravity_estimate.hpp"

namespace glint::slam {

// Values as the session file holds them: little-endian float64s. Null where the bytes are damaged.

/// x y z (m) qx qy qz qw.
using PoseBytes = std::array<std::byte, 7 * sizeof(double)>;
PoseBytes encode_pose(const Pose& pose);
std::optional<Pose> decode_pose(std::span<const std::byte> bytes);

/// A 6x6 matrix row by row.
using CovarianceBytes = std::array<std::byte, 36 * sizeof(double)>;
CovarianceBytes encode_covariance(const Eigen::Matrix<double, 6, 6>& covariance);
std::optional<Eigen::Matrix<double, 6, 6>> decode_covariance(std::span<const std::byte> bytes);

/// `up`, `bias_share` row by row, `sigma_rad`.
using GravityBytes = std::array<std::byte, 13 * sizeof(double)>;
GravityBytes encode_gravity(const FeltGravity& gravity);
std::optional<FeltGravity> decode_gravity(std::span<const std::byte> bytes);

}  // namespace glint::slam
