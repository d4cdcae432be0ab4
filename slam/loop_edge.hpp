// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// A loop closure: keyframe `to` is seen from keyframe `from` (the older one) at T_from_to.
struct LoopEdge {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  Pose T_from_to;
  /// Of T_from_to, right perturbation, x y z rx ry rz, m^2 and rad^2; large along an axis that the
  /// registration does not fix.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
};

/// What was found out about one candidate pair, whether it became an edge or not. Figures of steps
/// that were not reached are zero.
struct LoopCandidate {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
  bool accepted = false;
  std::string reason;       ///< Why not; empty when accepted.
  double similarity = 0.0;  ///< Of the bags of words, relative to that of neighbouring keyframes.
  int matches = 0;          ///< Pairs of keypoints.
  int inliers = 0;          ///< Of them, after the 3-D-3-D RANSAC.
  double overlap = 0.0;     ///< Share of the points that found a surface.
  double rms_m = 0.0;       ///< Of their distances to it.
  int corners = 0;          ///< Of the maps from above that agree, if these brought it up.
};

}  // namespace glint::slam
