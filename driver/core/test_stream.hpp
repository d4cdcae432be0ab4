// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <span>
#include <vector>

#include "driver/core/scan_assembler.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint::test {

/// A stream of one sensor into an assembler; what leaves is kept.
class Stream {
 public:
  explicit Stream(const SensorInfo& info, AssemblerOptions options = {})
      : assembler(info, options) {}

  PacketVerdict push(const Bytes& packet) {
    const PacketVerdict verdict = assembler.push(packet);
    collect();
    return verdict;
  }
  void push_all(std::span<const Bytes> packets) {
    for (const Bytes& packet : packets) push(packet);
  }
  void flush() {
    assembler.flush();
    collect();
  }
  [[nodiscard]] const AssemblerCounters& counters() const { return assembler.counters(); }

  ScanAssembler assembler;
  std::vector<LidarScan> scans;

 private:
  void collect() {
    while (const LidarScan* scan = assembler.next()) scans.push_back(*scan);
  }
};

/// A small sensor and its packets.
class AssemblerTest : public testing::Test {
 protected:
  static constexpr int kColumns = 512;
  static constexpr int kPackets = kColumns / 16;

  LidarScan scan(std::uint32_t frame_id) { return random_scan(info, frame_id, random); }
  std::vector<Bytes> packets(std::uint32_t frame_id) { return encode(info, scan(frame_id)); }

  SensorInfo info = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 16, kColumns);
  std::mt19937 random{5};
};

}  // namespace glint::test
