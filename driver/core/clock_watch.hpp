// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

#include "driver/core/lidar_scan.hpp"

namespace glint {

/// Notices jumps of the sensor's clock: column times that do not go on as the columns do, by more
/// than half a scan period. Thread-compatible.
class ClockWatch {
 public:
  explicit ClockWatch(std::int64_t scan_period_ns) : scan_period_ns_(scan_period_ns) {}

  /// Whether the clock jumped since the last column of the scan before, which may be in the middle
  /// of this one: then the times of its columns before the jump are moved to the clock after it, so
  /// that the scan's times are of one clock. Scans are given in their order.
  bool jumped(LidarScan& scan);
  /// The sensor restarted: its times begin anew as well.
  void begin_anew() { started_ = false; }

 private:
  [[nodiscard]] std::int64_t jump_ns(std::int64_t columns, int columns_per_scan,
                                     std::int64_t elapsed_ns) const;
  bool mend(LidarScan& scan, int first, int last) const;

  const std::int64_t scan_period_ns_;
  bool started_ = false;
  std::int64_t column_ = 0;  // the last valid one seen, counted on through all scans, and its
  SensorTime time_;          // time
};

}  // namespace glint
