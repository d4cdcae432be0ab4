// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/core/packet_format.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/emulator/packet_restamper.hpp"

namespace glint::emulator {

/// The whole scans of a capture and the IMU packets between them, kept in memory such that they
/// can be sent one loop after the other. Constant after construction; thread-safe.
class LoopedCapture {
 public:
  struct Packet {
    std::int64_t offset_ns = 0;  ///< Recorded so long after the loop's first packet.
    bool is_imu = false;
    std::uint32_t scan = 0;  ///< Of a lidar packet: 0 for the loop's first scan.
    std::size_t begin = 0;   ///< Of its bytes.
    std::size_t size = 0;
  };

  /// Reads all of `source`: up to its first restart or jump of time, from the first whole scan to
  /// the last one. Scans in between may lack what the capture lacks.
  /// @throws InputError when there is no whole scan, or packets of more than `max_bytes`.
  LoopedCapture(PacketSource& source, const SensorInfo& info, std::size_t max_bytes);

  [[nodiscard]] std::span<const Packet> packets() const { return packets_; }
  [[nodiscard]] std::span<const std::byte> bytes(const Packet& packet) const {
    return std::span(bytes_).subspan(packet.begin, packet.size);
  }
  [[nodiscard]] std::uint32_t scans() const { return scans_; }
  /// Frame id of the first scan, and the time of its first column.
  [[nodiscard]] std::uint32_t first_frame_id() const { return first_frame_id_; }
  [[nodiscard]] SensorTime first_time() const { return first_time_; }
  /// Duration of the loop, by the sensor's clock.
  [[nodiscard]] std::int64_t period_ns() const { return period_ns_; }
  [[nodiscard]] std::uint64_t lidar_packets() const { return lidar_packets_; }
  [[nodiscard]] std::uint32_t packets_per_scan() const { return packets_per_scan_; }
  [[nodiscard]] const PacketRestamper& restamper() const { return restamper_; }

 private:
  struct Survey;
  void read(PacketSource& source, const SensorInfo& info, std::size_t max_bytes, Survey& survey);
  void keep_whole_scans(const Survey& survey, std::int64_t scan_period_ns);

  std::vector<std::byte> bytes_;
  std::vector<Packet> packets_;
  PacketRestamper restamper_;
  std::uint32_t scans_ = 0;
  std::uint32_t first_frame_id_ = 0;
  SensorTime first_time_;
  std::int64_t period_ns_ = 0;
  std::uint64_t lidar_packets_ = 0;
  std::uint32_t packets_per_scan_ = 0;
};

}  // namespace glint::emulator
