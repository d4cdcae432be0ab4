// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <vector>

#include "driver/core/pose.hpp"
#include "driver/core/time.hpp"

namespace glint::slam {

/// Motion of the sensor during a scan, as a constant body velocity about a reference time.
class ConstantVelocity {
 public:
  /// `velocity`: m/s and rad/s in the sensor frame.
  ConstantVelocity(const Twist& velocity, SensorTime reference)
      : velocity_(velocity), reference_(reference) {}

  /// T_reference_t: takes points measured at `t` to the sensor frame at the reference time.
  [[nodiscard]] Pose at(SensorTime t) const {
    return se3_exp(velocity_ * (static_cast<double>(t - reference_) * kSecondsPerNs));
  }

 private:
  Twist velocity_;
  SensorTime reference_;
};

/// Brings each point, measured at its own time, to the reference time: out[i] = T_ref_t(i) * in[i].
void deskew(const std::vector<Eigen::Vector3d>& points_m, const std::vector<SensorTime>& times,
            const ConstantVelocity& motion, std::vector<Eigen::Vector3d>& out_m);

}  // namespace glint::slam
