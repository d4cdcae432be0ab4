// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "driver/core/bytes.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/profile_table.hpp"
#include "driver/core/time.hpp"

namespace glint {

/// Why bytes are no lidar packet of this sensor.
enum class PacketError {
  kNone,
  kSize,  ///< Not the size that metadata predicts.
  kType,  ///< The packet type field says it is not a lidar packet.
};

/// One column of a checked packet. Valid while the packet's bytes are.
class ColumnView {
 public:
  ColumnView(const PacketFormat& format, const std::byte* data) : format_(&format), data_(data) {}

  /// The stamp less the format's excess; on the wire at most 2^62 ns (146 years), so that
  /// differences and small steps from it cannot overflow.
  [[nodiscard]] SensorTime time() const {
    constexpr std::uint64_t kLatest_ns = 1ULL << 62U;
    const auto stamp_ns = std::min(load<std::uint64_t>(data_ + kColumnTimeOffset), kLatest_ns);
    return {static_cast<std::int64_t>(stamp_ns) - format_->stamp_excess_ns};
  }
  [[nodiscard]] std::uint16_t measurement_id() const {
    return load<std::uint16_t>(data_ + kMeasurementIdOffset);
  }
  /// The status word as on the wire: 32 bits legacy (all ones is good), 16 bits later (bit 0).
  [[nodiscard]] std::uint32_t status() const {
    if (!format_->legacy()) return load<std::uint16_t>(data_ + kColumnStatusOffset);
    return load<std::uint32_t>(data_ + format_->column_bytes - sizeof(std::uint32_t));
  }
  [[nodiscard]] bool valid() const { return (status() & 1U) != 0; }
  /// Frame id as repeated in legacy columns; meaningless for other profiles.
  [[nodiscard]] std::uint16_t legacy_frame_id() const {
    return load<std::uint16_t>(data_ + kLegacyFrameIdOffset);
  }
  /// First byte of the first pixel; H pixels of layout->pixel_bytes follow.
  [[nodiscard]] const std::byte* pixels() const {
    return data_ + format_->layout->column_header_bytes;
  }
  /// Decoded value of one channel of one pixel; 0 where the profile lacks the channel.
  [[nodiscard]] std::uint32_t value(Channel channel, int row) const;

 private:
  const PacketFormat* format_;
  const std::byte* data_;
};

/// What a lidar packet's header says of the sensor's state (sensor manual, "alert flags").
struct PacketHealth {
  std::uint8_t alert_flags = 0;          ///< Bit 7: any alert is active.
  std::uint8_t thermal_countdown_s = 0;  ///< Until it shuts down, while that is imminent.
  std::uint8_t shot_limiting_countdown_s = 0;
  std::uint8_t thermal_state = 0;        ///< 0 normal, 1 shutdown imminent.
  std::uint8_t shot_limiting_state = 0;  ///< 0 normal, 1 imminent, 2 to 9 levels of reduction.
};

/// The header that a packet must have to be of this type (1 lidar, 2 IMU, 3 zone) and have the
/// sensor's serial number, or its init id where that is not known; null when both or neither fit,
/// or neither number is known (0).
std::optional<PacketHeader> recognise_header(std::span<const std::byte> packet,
                                             std::uint64_t serial_number, std::uint32_t init_id,
                                             std::uint16_t type = 1);

/// A lidar packet whose size has been checked against the format: no accessor reads outside.
/// Non-owning; valid while the bytes are. Thread-compatible, no allocation, never throws.
class PacketView {
 public:
  /// Checks size and, where the profile has one, the type field.
  static std::optional<PacketView> parse(const PacketFormat& format,
                                         std::span<const std::byte> bytes,
                                         PacketError* error = nullptr);

  /// Frame id, format.frame_id_bits() wide: of the header, or of the first column for legacy
  /// packets.
  [[nodiscard]] std::uint32_t frame_id() const;
  /// Initialization id (24 bits) and serial number (40 bits); 0 for legacy packets.
  [[nodiscard]] std::uint32_t init_id() const;
  [[nodiscard]] std::uint64_t serial_number() const;
  /// Alert and limit fields; all zero for legacy packets.
  [[nodiscard]] PacketHealth health() const;
  /// Whether the CRC-64 in the footer is that of the packet; never for legacy packets, which have
  /// none. Reads every byte.
  [[nodiscard]] bool crc_matches() const;
  /// Column `index` of this packet, 0 <= index < columns_per_packet.
  [[nodiscard]] ColumnView column(int index) const {
    return {*format_, bytes_.data() + format_->layout->packet_header_bytes +
                          static_cast<std::size_t>(index) * format_->column_bytes};
  }
  [[nodiscard]] int column_count() const { return format_->columns_per_packet; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  PacketView(const PacketFormat& format, std::span<const std::byte> bytes)
      : format_(&format), bytes_(bytes) {}
  const PacketFormat* format_;
  std::span<const std::byte> bytes_;
};

}  // namespace glint
