// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "driver/core/pose.hpp"
#include "driver/core/time.hpp"

namespace glint::slam {

/// Motion of the sensor during a scan, as a constant body velocity about a reference time.
class ConstantVelocity {
 public:
  /// `velocity`: m/s and rad/s in the sensor frame. Times further than `longest_ns` from the
  /// reference are taken to be that far: the sensor's clock jumped in between.
  ConstantVelocity(const Twist& velocity, SensorTime reference, std::int64_t longest_ns)
      : velocity_(velocity), reference_(reference), longest_ns_(longest_ns) {}

  /// T_reference_t: takes points measured at `t` to the sensor frame at the reference time.
  [[nodiscard]] Pose at(SensorTime t) const {
    const std::int64_t ahead_ns = std::clamp(t - reference_, -longest_ns_, longest_ns_);
    return se3_exp(velocity_ * (static_cast<double>(ahead_ns) * kSecondsPerNs));
  }

 private:
  Twist velocity_;
  SensorTime reference_;
  std::int64_t longest_ns_;
};

/// Brings each point, measured at its own time, to the reference time: out[i] = T_ref_t(i) * in[i].
void deskew(const std::vector<Eigen::Vector3d>& points_m, const std::vector<SensorTime>& times,
            const ConstantVelocity& motion, std::vector<Eigen::Vector3d>& out_m);

}  // namespace glint::slam
