// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint::test {

/// A sensor behind a bad line: random scans, some of whose columns are invalid and some of whose
/// packets are lost, doubled, and permuted within what the assembler waits for. Knows what it did
/// and what must come of it.
class BadLine {
 public:
  struct Faults {
    double loss = 0.02;
    double doubled = 0.02;
  };

  BadLine(const SensorInfo& info, Faults faults, std::uint32_t seed);

  /// The sensor runs for so many scans, frame ids counted from `frame_id`; it stops in the middle
  /// of the last one if `cut`.
  void run(int count, std::uint32_t frame_id, bool cut = false);
  /// From here on packets carry another init id; then run() begins a new numbering.
  void restart();
  /// Nothing arrives for so many scans, which the sensor goes on sending: part of the next run().
  void outage(int count) { outage_scans_ = count; }

  std::vector<Bytes> wire;          ///< In the order of arrival.
  std::vector<LidarScan> scans;     ///< That must come out: of which any packet arrived.
  std::uint64_t doubled = 0;        ///< Late and duplicate packets.
  std::uint64_t arrived = 0;        ///< Without the doubles.
  std::uint64_t never_arrived = 0;  ///< Between the first and the last that arrived of a run.

 private:
  void send(LidarScan scan, int packets, std::vector<Bytes>& run);
  void add_doubles(std::vector<Bytes>& run);
  void shuffle(std::vector<Bytes>& run);
  void fill_unused_bits(Bytes& packet);
  bool chance(double share);

  SensorInfo info_;
  const Faults faults_;
  std::mt19937 random_;
  std::vector<std::uint8_t> column_expected_;
  const Bytes unused_bits_;
  std::int64_t scans_sent_ = 0;
  int outage_scans_ = 0;
  std::vector<bool> run_arrived_;  ///< A flag a packet sent in this run.
};

}  // namespace glint::test
