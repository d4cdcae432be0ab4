// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/core/imu_packet.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {

/// Encodes IMU measurements as a sensor's packets: the inverse of parse_imu_packet(), up to the
/// float32 of the wire. Used by the simulator and by tests. Thread-compatible.
class ImuPacketWriter {
 public:
  explicit ImuPacketWriter(const SensorInfo& info);

  [[nodiscard]] const ImuPacketFormat& format() const { return format_; }

  /// Writes a packet into `out`, resized to the packet size. `samples` must be as many as
  /// format().measurements. `frame_id` and `index`, which counts the packets of a frame from 0, are
  /// not in legacy packets. Later ones have one time for both sensors: that of the accelerometer.
  void write(std::span<const ImuSample> samples, std::uint16_t frame_id, int index,
             std::vector<std::byte>& out) const;

 private:
  void write_nmea(std::span<const ImuSample> samples, std::uint16_t frame_id, int index,
                  std::vector<std::byte>& out) const;

  ImuPacketFormat format_;
  std::uint64_t identity_;  ///< Init id and serial number as they stand in the header.
  int columns_per_frame_;
  int packets_per_frame_;
};

}  // namespace glint
