// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>

#include "driver/core/pose.hpp"
#include "slam/degeneracy.hpp"

namespace glint::slam {

/// How far the pose may have gone astray along axes that surfaces leave open. On critical ones
/// nothing but the motion before tells it: an unknown speed adds up with time, not with its root.
/// What keypoints and patches carry drifts a little with the way. Thread-compatible.
class BlindDrift {
 public:
  /// What one more scan adds to the covariance of T_odom_scan: translation then rotation, right
  /// perturbation. Nothing without weak axes.
  Eigen::Matrix<double, 6, 6> add(const WeakAxes& axes, const Pose& T_odom_scan,
                                  const Twist& velocity, double span_s);
  /// Whether this is to be told: some scans in a row were blind; as many that see end it.
  [[nodiscard]] bool is_blind() const { return blind_; }
  void reset() { *this = {}; }

 private:
  [[nodiscard]] double sigma_m(double blind_s, double speed_mps) const;

  double blind_s_ = 0.0;
  int in_a_row_ = 0;  ///< Scans that contradict `blind_`.
  bool blind_ = false;
};

}  // namespace glint::slam
