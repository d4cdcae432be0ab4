// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

#include "driver/core/open_scan.hpp"

namespace glint {

/// Counts the packets that did not come, by the scans that left: those between the first and the
/// last that came since the sensor started. What it sent before and after those, if anything,
/// nobody can tell. Thread-compatible.
class ArrivalLedger {
 public:
  ArrivalLedger(const ColumnWindow& window, int columns_per_packet)
      : window_(window), columns_per_packet_(columns_per_packet) {}

  /// How many are missing since the scan before, up to and with this one. Scans are given in their
  /// order; `newest`: no packet of a newer one has come.
  std::uint64_t missing(const OpenScan& scan, bool newest);
  /// The sensor restarted.
  void begin_anew() { started_ = false; }

 private:
  const ColumnWindow& window_;
  const int columns_per_packet_;
  // Accounted for so far: packets before this one, of this scan and all before it.
  bool started_ = false;
  std::int64_t sequence_ = 0;
  int packet_ = 0;
};

}  // namespace glint
