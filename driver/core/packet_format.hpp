// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "driver/core/profile_layout.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {

/// The table's row for a profile. Never fails: every LidarProfile has a row.
const ProfileLayout& profile_layout(LidarProfile profile);

/// The byte layout of one sensor's packets: a profile's row and the sensor's dimensions.
struct PacketFormat {
  /// @throws MetadataError if the packet would pass the UDP limit of 65,507 bytes.
  explicit PacketFormat(const SensorInfo& info);

  const ProfileLayout* layout;  ///< Row of the constant table.
  int columns_per_frame;
  int columns_per_packet;
  int pixels_per_column;
  PacketHeader header;
  std::int64_t stamp_excess_ns;  ///< As SensorInfo::stamp_excess_ns().
  std::size_t column_bytes;
  std::size_t packet_bytes;
  /// Of the sensor's IMU packets, which older firmware marks by nothing but their size.
  std::size_t imu_packet_bytes;

  [[nodiscard]] bool legacy() const { return layout->profile == LidarProfile::kLegacy; }
  /// Width of the frame id on the wire.
  [[nodiscard]] int frame_id_bits() const { return header == PacketHeader::kFusa ? 32 : 16; }
  [[nodiscard]] bool has(Channel c) const { return layout->field(c).present(); }
};

/// Size of a legacy IMU packet; it has no header, id or serial.
constexpr std::size_t kLegacyImuPacketBytes = 48;

}  // namespace glint
