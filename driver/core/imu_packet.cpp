// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/imu_packet.hpp"

#include <cmath>
#include <cstdint>

#include "driver/core/bytes.hpp"
#include "driver/core/packet_format.hpp"

namespace glint {
namespace {

constexpr double kStandardGravity_mps2 = 9.80665;
constexpr double kRadiansPerDegree = M_PI / 180.0;

// The packet begins with a monotonic time for diagnostics, which nothing here needs.
constexpr int kAccelTimeOffset = 8;
constexpr int kGyroTimeOffset = 16;
constexpr int kAccelerationOffset = 24;
constexpr int kAngularRateOffset = 36;

Eigen::Vector3d load_vector(const std::byte* from) {
  return {load<float>(from), load<float>(from + 4), load<float>(from + 8)};
}

}  // namespace

std::optional<ImuSample> parse_legacy_imu(std::span<const std::byte> bytes) {
  if (bytes.size() != kLegacyImuPacketBytes) return std::nullopt;
  const std::byte* packet = bytes.data();
  ImuSample sample;
  sample.accel_time = {load<std::int64_t>(packet + kAccelTimeOffset)};
  sample.gyro_time = {load<std::int64_t>(packet + kGyroTimeOffset)};
  sample.acceleration_mps2 = kStandardGravity_mps2 * load_vector(packet + kAccelerationOffset);
  sample.angular_rate_radps = kRadiansPerDegree * load_vector(packet + kAngularRateOffset);
  if (!sample.acceleration_mps2.allFinite() || !sample.angular_rate_radps.allFinite()) {
    return std::nullopt;
  }
  return sample;
}

}  // namespace glint
