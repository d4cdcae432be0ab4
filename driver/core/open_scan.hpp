// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <vector>

#include "driver/core/clock_watch.hpp"
#include "driver/core/lidar_scan.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {

/// The columns that a sensor sends, those of its azimuth window, in the order of measurement: the
/// frame id steps at column 0, so a window that wraps ends at column W - 1.
struct ColumnWindow {
  explicit ColumnWindow(const SensorInfo& info);

  std::vector<std::uint8_t> expected;         ///< W flags.
  std::vector<std::uint8_t> packet_expected;  ///< A flag a packet: it holds expected columns.
  int count = 0;                              ///< Expected columns.
  int packets = 0;                            ///< Expected packets.
  int middle = 0;                             ///< The expected column measured half-way.
  int last = 0;                               ///< The expected column measured last.
};

/// A scan being filled, with what is known of it. Its buffers are reused from scan to scan; pixels
/// of the scan before are still there until finish() clears those that nothing overwrote.
struct OpenScan {
  explicit OpenScan(const PacketFormat& format)
      : scan(format), arrived(static_cast<std::size_t>(format.columns_per_frame)) {}

  void start(std::uint32_t frame_id, std::int64_t unwrapped_id, std::int64_t position);
  /// Zeroes what never came or was invalid, and fills in completeness and times.
  void finish(const ColumnWindow& window, std::int64_t scan_period_ns, ClockWatch& clock);

  LidarScan scan;
  std::vector<std::uint8_t> arrived;  ///< W flags: the column came, valid or not.
  int expected_arrived = 0;           ///< How many of these the window expects.
  int newer_packets = 0;              ///< Packets of newer scans that came meanwhile.
  std::int64_t sequence = 0;
  std::int64_t opened_at = 0;  ///< Column that opened it, counted on through all scans.
};

/// Time of a column of a scan: its own, or interpolated between the nearest valid ones, or
/// extrapolated from the nearest valid one. Zero for a scan without a valid column.
SensorTime estimate_column_time(const LidarScan& scan, int column, std::int64_t scan_period_ns);

}  // namespace glint
