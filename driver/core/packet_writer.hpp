// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {

/// Encodes scans as lidar packets: the exact inverse of PacketView and ScanAssembler, from the same
/// table. Used by the simulator and by tests. Thread-compatible.
class PacketWriter {
 public:
  explicit PacketWriter(const SensorInfo& info);

  [[nodiscard]] int packets_per_scan() const;
  /// Writes packet `index` of `scan` (columns index*columns_per_packet onwards) into `out`, resized
  /// to the packet size. Values wider than their field saturate to its largest value; range is
  /// rounded down to the field's step. Columns keep the scan's own time, status and id.
  void write(const LidarScan& scan, int index, std::vector<std::byte>& out) const;

 private:
  void write_header(std::uint32_t frame_id, std::byte* to) const;

  PacketFormat format_;
  std::uint32_t init_id_;
  std::uint64_t serial_number_;
};

}  // namespace glint
