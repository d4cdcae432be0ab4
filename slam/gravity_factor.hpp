// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/core/pose.hpp"
#include "slam/gravity_estimate.hpp"

namespace glint::slam {

/// What a node of the pose graph felt of gravity. Nodes of a group hold together and have one up.
struct GravityFactor {
  std::size_t node = 0;
  std::uint32_t group = 0;
  FeltGravity felt;
};

/// What all nodes of a group felt together. Where up is was never measured but by them, so it is
/// told along with the accelerometer's bias: gravity keeps a map from bending, and does not turn
/// it as a whole.
struct GravityFit {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();   ///< Map frame, unit length.
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< Sensor frame, as a share of gravity.
};

/// Deviation of an accelerometer's bias, an axis, as a share of gravity: of one that nobody has
/// calibrated.
constexpr double kAccelerometerBias = 0.03;

/// By least squares of the factors, all of one group, at the nodes' poses; those that do not fit
/// count less. Deterministic.
GravityFit fit_gravity(std::span<const GravityFactor> factors, std::span<const Pose> poses);

/// By how much a node is tilted against what it felt, rad.
double tilt_rad(const GravityFactor& factor, const Pose& T_map_node, const GravityFit& fit);

}  // namespace glint::slam
