// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/imu_track.hpp"

namespace glint::slam {

/// The direction against gravity as a sensor felt it over the last seconds. Value type.
struct FeltGravity {
  /// Upwards, sensor frame at the end, unit length; with the accelerometer's bias in it.
  Eigen::Vector3d up;
  /// Takes the bias, sensor frame, as a share of gravity's strength, to what it adds to `up`: less
  /// than all of it where the sensor turned on its way.
  Eigen::Matrix3d bias_share;
  double sigma_rad = 0.0;  ///< Of `up`, an axis, besides the bias.
};

/// Tells gravity from the sensor's own acceleration: what remains of the way that odometry found
/// when what the accelerometer felt is taken from it is a fall, the same over some seconds. Poses
/// are from the last seconds only, so that drift of odometry's tilt shows in it. Thread-compatible;
/// no allocation after construction.
class GravityEstimate {
 public:
  GravityEstimate();

  /// The sensor moved from T_odom_from to T_odom_to in `span_s`, while the IMU felt `felt` (frame
  /// of `from`). Begins anew where `from` is not where the last motion ended.
  void add(const Pose& T_odom_from, const Pose& T_odom_to, const ImuMotion& felt, double span_s);
  void clear() { count_ = 0; }
  /// Null before there are seconds enough, or where motion and force do not go together.
  [[nodiscard]] std::optional<FeltGravity> felt() const;

 private:
  /// The end of a motion, odometry frame.
  struct Node {
    Pose T_odom_sensor;
    double span_s = 0.0;  ///< Of the motion that ended here, and what was felt on it:
    Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
    Eigen::Vector3d way_m = Eigen::Vector3d::Zero();
  };

  [[nodiscard]] const Node& node(std::size_t steps_back) const {
    return nodes_[(next_ + nodes_.size() - 1 - steps_back) % nodes_.size()];
  }
  void push(const Node& node);
  void forget_old();

  std::vector<Node> nodes_;  ///< A ring of the last `count_`; `next_` is the place to be taken.
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace glint::slam
