// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/packet_view.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {

/// What became of everything that was pushed. Every packet and column is in exactly one of them.
struct AssemblerCounters {
  std::uint64_t packets = 0;            ///< Lidar packets accepted.
  std::uint64_t bad_size = 0;           ///< Not the sensor's packet size.
  std::uint64_t bad_type = 0;           ///< Not a lidar packet by its type field.
  std::uint64_t bad_serial = 0;         ///< Another sensor's.
  std::uint64_t bad_column = 0;         ///< Columns with measurement id >= W.
  std::uint64_t late_packets = 0;       ///< For a scan that had already left.
  std::uint64_t duplicate_packets = 0;  ///< All of whose columns were already there.
  std::uint64_t missing_packets = 0;    ///< Never came, of scans that left.
  std::uint64_t stray_packets = 0;      ///< Frame id ahead of what the packet's time allows.
  std::uint64_t restarts = 0;  ///< Init id changed, or frame ids began anew for a scan's worth.
  std::uint64_t scans = 0;     ///< Scans that left.
  std::uint64_t incomplete_scans = 0;  ///< Left before every expected column had come.
  std::uint64_t untaken_scans = 0;     ///< Nobody asked for them with next() in time.
};

struct AssemblerOptions {
  /// Packets of newer scans that may arrive before an incomplete scan is given up.
  int reorder_window_packets = 4;
  /// An incomplete scan leaves once a newer column is this many scan periods past its first one.
  double timeout_periods = 1.5;
};

/// Packets in, scans out: puts columns where they belong whatever the order, loss or duplication.
/// A scan leaves as soon as its last expected column is in. Works by packet contents and packet
/// times only, so a stream gives the same scans live and in replay.
/// Thread-compatible. push() does not allocate and does not throw.
class ScanAssembler {
 public:
  explicit ScanAssembler(const SensorInfo& info, AssemblerOptions options = {});
  ~ScanAssembler();
  ScanAssembler(const ScanAssembler&) = delete;
  ScanAssembler& operator=(const ScanAssembler&) = delete;

  /// Takes one datagram. Afterwards call next() until it gives null: scans not taken by then are
  /// kept, up to the number of open scans.
  PacketError push(std::span<const std::byte> datagram);
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

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint
