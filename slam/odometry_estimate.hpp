// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>

#include "driver/core/pose.hpp"
#include "driver/core/time.hpp"
#include "slam/degeneracy.hpp"

namespace glint::slam {

/// How far a pose can be trusted. Precedence when several apply: PAUSED, LOST, LOCALIZING, INIT,
/// DEGRADED, TRACKING.
enum class TrackingState { kInit, kTracking, kDegraded, kLost, kLocalizing, kPaused };
/// "UNKNOWN" for what is none of them.
std::string_view to_string(TrackingState state);
/// Null for what is no state's name.
std::optional<TrackingState> tracking_state_from(std::string_view name);

/// What one scan says of the sensor's motion. Value type.
struct OdometryEstimate {
  std::uint64_t sequence = 0;  ///< LidarScan::sequence.
  std::uint32_t frame_id = 0;  ///< As on the wire.
  /// The pose belongs to the time of the scan's nominal last column.
  SensorTime stamp;
  /// Pose of the sensor in the odometry frame (smooth, drifts). Always finite.
  Pose T_odom_sensor;
  /// Velocity of the sensor in the sensor frame: m/s, then rad/s.
  Twist velocity = Twist::Zero();
  /// Covariance of T_odom_sensor's last increment accumulated from the start: x y z rx ry rz, right
  /// perturbation (sensor frame), m^2 and rad^2.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  TrackingState state = TrackingState::kInit;
  /// Steps each time tracking restarts without a link to what came before.
  std::uint32_t segment = 0;
  double completeness = 0.0;
  /// What the scan's surfaces leave open.
  WeakAxes weak_axes;
  int keypoints = 0;
  int matches = 0;
  int inliers = 0;
};

}  // namespace glint::slam
