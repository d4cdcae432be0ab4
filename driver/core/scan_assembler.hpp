// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "driver/core/assembler_counters.hpp"
#include "driver/core/lidar_scan.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/packet_gate.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {

struct AssemblerOptions {
  /// Packets of newer scans that may arrive before an incomplete scan is given up.
  int reorder_window_packets = 4;
  /// An incomplete scan leaves once a second packet of newer ones is this many scans past its
  /// first.
  double timeout_periods = 1.5;
};

/// Packets in, scans out: puts columns where they belong whatever the order, loss or duplication.
/// A scan leaves as soon as its last expected column is in. Works by packet contents only, so a
/// stream gives the same scans live and in replay; what the sensor's clock does to packet times
/// costs no scan.
/// Thread-compatible. push() does not allocate and does not throw.
class ScanAssembler {
 public:
  explicit ScanAssembler(const SensorInfo& info, AssemblerOptions options = {});
  ~ScanAssembler();
  ScanAssembler(const ScanAssembler&) = delete;
  ScanAssembler& operator=(const ScanAssembler&) = delete;

  /// Takes one datagram of any kind and says what it is. Afterwards call next() until it gives
  /// null: scans not taken by then are kept, up to the number of open scans.
  PacketVerdict push(std::span<const std::byte> datagram);
  /// The next finished scan, or null. Valid until the next call of push(), flush() or next().
  const LidarScan* next();
  /// The stream ended or fell silent: unfinished scans leave as they are, by next().
  void flush();
  /// The sensor has restarted with the same packets, or was replaced by one of its kind: whose
  /// packets are taken from here on.
  void set_identity(const SensorInfo& info);
  /// What follows are packets of another layout. Drops what is unfinished or not taken, counts and
  /// numbers on. Allocates.
  void change_sensor(const SensorInfo& info);

  [[nodiscard]] const AssemblerCounters& counters() const;
  [[nodiscard]] const PacketFormat& format() const;
  /// As PacketGate::health().
  [[nodiscard]] const std::optional<PacketHealth>& health() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint
