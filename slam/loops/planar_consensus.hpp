// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace glint::slam {

/// A corner of one map and the one that it looks like in another, seen from above.
struct PlanarPair {
  Eigen::Vector2f reference_m = Eigen::Vector2f::Zero();
  Eigen::Vector2f current_m = Eigen::Vector2f::Zero();
};

/// reference = R(yaw) current + translation, and how many pairs say so.
struct PlanarConsensus {
  double yaw_rad = 0.0;
  Eigen::Vector2d translation_m = Eigen::Vector2d::Zero();
  int inliers = 0;
};

/// The turn and shift in the plane that most pairs agree on within `gate_m`, by samples of two
/// [Fischler & Bolles 1981], then fitted to those that do. It is built from an angle, so that a
/// mirror image never fits. The same pairs give the same result. Pure: any thread, no state.
PlanarConsensus find_planar_consensus(std::span<const PlanarPair> pairs, float gate_m);

}  // namespace glint::slam
