// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

namespace glint {

/// What became of everything that was pushed. Every datagram is in exactly one of the first group,
/// whose sum is datagrams(); the others tell more of the same ones.
struct AssemblerCounters {
  std::uint64_t packets = 0;            ///< Lidar packets accepted.
  std::uint64_t imu_packets = 0;        ///< The sensor's IMU packets.
  std::uint64_t zone_packets = 0;       ///< The sensor's zone monitoring packets.
  std::uint64_t bad_size = 0;           ///< Not the size of any of the sensor's packets.
  std::uint64_t bad_type = 0;           ///< Of a packet's size, but its type field says otherwise.
  std::uint64_t bad_serial = 0;         ///< Another sensor's.
  std::uint64_t corrupt_packets = 0;    ///< The CRC, until then always right, does not match.
  std::uint64_t late_packets = 0;       ///< For a scan that had already left.
  std::uint64_t duplicate_packets = 0;  ///< All of whose columns were already there.
  std::uint64_t stray_packets = 0;      ///< Frame id far from those before: damaged, or begun anew.

  /// Packets that had not come when their scan left, between the first and the last that came of
  /// the sensor's run; those of whole scans of which nothing came are among them.
  std::uint64_t missing_packets = 0;
  std::uint64_t crc_mismatches = 0;  ///< Packets whose CRC does not match, rejected or not.
  std::uint64_t bad_column = 0;      ///< Columns with measurement id >= W.
  std::uint64_t restarts = 0;     ///< Init id changed, or frame ids began anew without one to tell.
  std::uint64_t clock_jumps = 0;  ///< Scans flagged LidarScan::clock_jumped.
  std::uint64_t scans = 0;        ///< Scans that left.
  std::uint64_t incomplete_scans = 0;  ///< Left before every expected column had come.
  std::uint64_t untaken_scans = 0;     ///< Nobody asked for them with next() in time.

  /// Everything that was pushed.
  [[nodiscard]] std::uint64_t datagrams() const {
    return packets + imu_packets + zone_packets + bad_size + bad_type + bad_serial +
           corrupt_packets + late_packets + duplicate_packets + stray_packets;
  }
};

}  // namespace glint
