// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "driver/core/sensor_info.hpp"

namespace glint {

/// Where a field's bits lie in a pixel and how they become a value:
/// value = ((bits >> 0) & mask) * scale. `width_bits` 0 means that the profile lacks the field.
struct PixelField {
  int offset_bits = 0;
  int width_bits = 0;
  int scale = 1;  ///< e.g. 8 for range in steps of 8 mm.
  [[nodiscard]] constexpr bool present() const { return width_bits > 0; }
};

/// The channels a pixel can carry.
enum class Channel { kRange, kSignal, kReflectivity, kNearIr, kRange2, kSignal2, kReflectivity2 };
constexpr std::size_t kChannelCount = 7;

/// One row of the table of profiles.
struct ProfileLayout {
  LidarProfile profile;
  int pixel_bytes;
  int packet_header_bytes;
  int column_header_bytes;
  int column_footer_bytes;
  int packet_footer_bytes;
  std::array<PixelField, kChannelCount> fields;
  [[nodiscard]] constexpr const PixelField& field(Channel c) const {
    return fields[static_cast<std::size_t>(c)];
  }
};

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
