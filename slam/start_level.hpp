// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <optional>

#include "driver/core/pose.hpp"
#include "slam/imu_track.hpp"

namespace glint::slam {

/// Where down is, for odometry that began while the sensor moved: what it felt in its first scan
/// was no weight alone then. Over the first two seconds what odometry says of the change of
/// velocity is taken from what was felt. Of a sensor that began at rest it says nothing: its first
/// scan tells better. Value type; thread-compatible.
class StartLevel {
 public:
  void begin() { *this = {}; }
  /// The sensor moved from T_odom_from to T_odom_to in `span_s`, while the IMU felt `felt` (frame
  /// of `from`). Gravity in the odometry frame, m/s^2, once it is known better than before.
  std::optional<Eigen::Vector3d> add(const Pose& T_odom_from, const Pose& T_odom_to,
                                     const ImuMotion& felt, double span_s);

 private:
  int motions_ = 0;
  bool done_ = false;
  Eigen::Vector3d first_mps_ = Eigen::Vector3d::Zero();   ///< Velocity in the middle of a motion.
  Eigen::Vector3d gained_mps_ = Eigen::Vector3d::Zero();  ///< By what was felt since then.
  double since_s_ = 0.0;
  Eigen::Vector3d last_gained_mps_ = Eigen::Vector3d::Zero();  ///< In the last motion.
  double last_span_s_ = 0.0;
};

}  // namespace glint::slam
