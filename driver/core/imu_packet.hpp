// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>

#include "driver/core/time.hpp"

namespace glint {

/// One IMU measurement in SI units, axes parallel to the sensor frame (only a translation differs).
struct ImuSample {
  SensorTime accel_time;
  SensorTime gyro_time;
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rate_radps = Eigen::Vector3d::Zero();
};

/// Decodes a legacy IMU packet (48 bytes: g and deg/s on the wire). Null for any other size or
/// non-finite values.
std::optional<ImuSample> parse_legacy_imu(std::span<const std::byte> bytes);

}  // namespace glint
