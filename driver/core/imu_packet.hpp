// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "driver/core/sensor_info.hpp"
#include "driver/core/time.hpp"

namespace glint {

/// One IMU measurement in SI units, axes parallel to the sensor frame (only a translation differs).
struct ImuSample {
  SensorTime accel_time;
  SensorTime gyro_time;
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rate_radps = Eigen::Vector3d::Zero();
};

/// The size of one sensor's IMU packets and what they hold.
struct ImuPacketFormat {
  explicit ImuPacketFormat(const SensorInfo& info);

  ImuProfile profile;
  int measurements;  ///< In a packet.
  std::size_t packet_bytes;
  std::int64_t stamp_excess_ns;  ///< As SensorInfo::stamp_excess_ns().
};

/// Whether the CRC in a packet's footer must match. Old firmware leaves it empty or fills it with
/// something else, so it says nothing until a stream has been seen to get it right.
enum class CrcCheck { kNone, kRequired };

/// Decodes an IMU packet of either profile and appends its measurements to `samples`, leaving out
/// those that the sensor marks invalid and non-finite ones. False, and nothing appended, if the
/// bytes are no IMU packet of this format: another size or type, or a required CRC that does not
/// match (legacy packets have none). Never reads outside `bytes`; thread-safe.
bool parse_imu_packet(const ImuPacketFormat& format, std::span<const std::byte> bytes,
                      std::vector<ImuSample>& samples, CrcCheck crc = CrcCheck::kNone);

/// Decodes a legacy IMU packet (48 bytes: g and deg/s on the wire). Null for any other size or
/// non-finite values.
std::optional<ImuSample> parse_legacy_imu(std::span<const std::byte> bytes);

}  // namespace glint
