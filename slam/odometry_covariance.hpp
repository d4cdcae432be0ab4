// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <utility>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// How uncertain odometry's pose has become: since its origin, and since the last keyframe.
/// Covariances are of translation then rotation, right perturbation, m^2 and rad^2.
/// Thread-compatible.
class OdometryCovariance {
 public:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  OdometryCovariance() { reset(); }

  /// One more step, which adds `increment`.
  void add(const Pose& step, const Matrix6& increment);
  /// A scan without any measurement: the motion before went on, with unknown accelerations.
  void coast();
  /// An origin, which is a scan that was not measured exactly either.
  void reset();

  [[nodiscard]] const Matrix6& since_origin() const { return since_origin_; }
  /// Of the motion since this was called last.
  [[nodiscard]] Matrix6 take_since_keyframe() {
    return std::exchange(since_keyframe_, Matrix6(Matrix6::Zero()));
  }

 private:
  Matrix6 since_origin_;
  Matrix6 since_keyframe_ = Matrix6::Zero();
};

/// What a step located against a map adds. The map's errors, which each scan's pose inherits,
/// change but slowly: what odometry drifts by goes with time, whatever the rate of scans, and is
/// less than each scan's own uncertainty `own`. Calibrated over simulated worlds, see DESIGN.md.
OdometryCovariance::Matrix6 drift_gained(const OdometryCovariance::Matrix6& own, double span_s);

}  // namespace glint::slam
