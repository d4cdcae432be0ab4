// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "driver/core/imu_packet.hpp"

namespace glint {

/// Which way is up for a sensor, by the accelerometer while it is at rest. Thread-compatible; no
/// allocation.
class GravityEstimate {
 public:
  /// Takes the measurements in the order of their times; a gap or a time that goes back begins
  /// anew.
  void add(const ImuSample& sample);

  /// Measurements a second, over the last full half second; 0 before.
  [[nodiscard]] double rate_hz() const { return rate_hz_; }
  /// Mean acceleration that was measured while at rest, m/s^2, sensor frame: it points up and is as
  /// long as gravity. Follows with a time constant of some seconds; null if it was never at rest.
  [[nodiscard]] const std::optional<Eigen::Vector3d>& up_mps2() const { return up_mps2_; }

 private:
  /// Sums over half a second.
  struct Block {
    int count = 0;
    SensorTime begin;
    SensorTime end;
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
    double acceleration_squared = 0.0;
    double rate_squared = 0.0;
  };
  void close_block();

  Block block_;
  double rate_hz_ = 0.0;
  std::optional<Eigen::Vector3d> up_mps2_;
};

/// Angle between the up that was measured in the sensor frame and the up that a mounting says
/// (z of the base), degrees, 0 to 180. `up` must not be zero.
double mount_tilt_deg(const Eigen::Vector3d& up, const Eigen::Quaterniond& R_base_sensor);

}  // namespace glint
