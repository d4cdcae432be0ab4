// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// Keyframes in a row of which only the first and the last are seen by a loop. For the pose graph
/// they are one edge; what the graph makes of its two ends is then spread over those between, as
/// the least squares of all their steps would have it (to first order in the correction): that
/// solves a graph of as many nodes as loops have ends rather than one of all keyframes.
class OdometryChain {
 public:
  /// `T_odom`: the keyframes' poses by odometry. `covariances`: of the step to each, right
  /// perturbation; the first is not looked at. Both of the same size, at least two.
  OdometryChain(std::span<const Pose> T_odom,
                std::span<const Eigen::Matrix<double, 6, 6>> covariances);

  /// The edge from the first to the last keyframe, and its covariance.
  [[nodiscard]] const Pose& edge() const { return T_first_.back(); }
  [[nodiscard]] const Eigen::Matrix<double, 6, 6>& covariance() const { return covariance_.back(); }

  /// Sets the poses between the first and the last, which are given.
  void spread(std::span<Pose> poses) const;

 private:
  std::vector<Pose> T_first_;                            ///< Each by odometry, from the first.
  std::vector<Eigen::Matrix<double, 6, 6>> covariance_;  ///< Of that.
};

}  // namespace glint::slam
