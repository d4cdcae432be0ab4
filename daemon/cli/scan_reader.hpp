// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "driver/core/lidar_scan.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/scan_assembler.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::cli {

/// Reads the scans of a source that ends, one after the other. Thread-compatible.
class ScanReader {
 public:
  ScanReader(PacketSource& source, const SensorInfo& info) : source_(source), assembler_(info) {}

  /// The next scan, the unfinished last one included; null at the end. Valid until the next call.
  const LidarScan* next();

  [[nodiscard]] const ScanAssembler& assembler() const { return assembler_; }

 private:
  PacketSource& source_;
  ScanAssembler assembler_;
  RawPacket packet_;
  bool flushed_ = false;
};

}  // namespace glint::cli
