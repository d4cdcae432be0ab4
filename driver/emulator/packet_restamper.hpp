// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/core/imu_packet.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::emulator {

/// How a packet is to differ from the one that was recorded. Value type.
struct PacketStamp {
  std::int64_t time_shift_ns = 0;  ///< Added to every time but 0, which means none.
  std::uint32_t frame_shift = 0;   ///< Added to every frame id, in the width of the field.
  std::uint32_t init_id = 0;       ///< In its place, where the format has one; 0: as recorded.
};

/// Rewrites times and ids of recorded packets in place, so that they are those of another moment
/// and start of their sensor: every lidar profile and header, both IMU profiles. Stateless after
/// construction; thread-safe.
class PacketRestamper {
 public:
  /// `format` has the header that the packets really have. `write_crc`: their CRC is right and is
  /// to stay so; otherwise it stays as it is.
  PacketRestamper(const PacketFormat& format, const ImuPacketFormat& imu, bool write_crc)
      : format_(format), imu_(imu), write_crc_(write_crc) {}

  /// False, and nothing changed, when the bytes are no lidar packet of the format by their size.
  bool restamp_lidar(std::span<std::byte> packet, const PacketStamp& stamp) const;
  /// The same for IMU packets.
  bool restamp_imu(std::span<std::byte> packet, const PacketStamp& stamp) const;
  /// Makes it another sensor's packet; false when the format has no serial number.
  bool change_serial_number(std::span<std::byte> lidar_packet) const;

 private:
  void finish(std::span<std::byte> packet) const;

  PacketFormat format_;
  ImuPacketFormat imu_;
  bool write_crc_;
};

}  // namespace glint::emulator
