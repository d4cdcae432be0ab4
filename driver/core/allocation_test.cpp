// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gtest/gtest.h>

#include <memory>

#include "driver/core/scan_assembler.hpp"
#include "driver/core/test_sensor.hpp"
#include "tests/support/alloc_counter.hpp"

namespace glint {
namespace {

class Allocation : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::heap_allocations_are_counted()) GTEST_SKIP() << "not counted under a sanitizer";
  }
};

TEST_F(Allocation, CounterSeesNewAndMalloc) {
  const std::uint64_t before = test::heap_allocations();
  auto block = std::make_unique<std::vector<int>>(1000);
  EXPECT_GE(test::heap_allocations() - before, 2U);
}

// Packets of a stream with losses, disorder, duplicates and a restart.
std::vector<test::Bytes> bad_stream(SensorInfo info, std::size_t packets) {
  std::mt19937 random(8);
  std::vector<test::Bytes> wire;
  for (std::uint16_t id = 0; wire.size() < packets; ++id) {
    if (id == 100) ++info.init_id;
    for (const test::Bytes& packet : test::encode(info, test::random_scan(info, id, random))) {
      const auto chance = random() % 100;
      if (chance == 0) continue;
      wire.push_back(packet);
      if (chance == 1) wire.push_back(packet);
      if (chance < 10 && wire.size() > 6)
        std::swap(wire.back(), wire[wire.size() - 1 - random() % 6]);
    }
  }
  return wire;
}

TEST_F(Allocation, TenThousandPacketsCauseNone) {
  for (const auto profile : {LidarProfile::kLegacy, LidarProfile::kRng19Rfl8Sig16Nir16}) {
    const SensorInfo info = test::make_sensor(profile, 64, 1024);
    const std::vector<test::Bytes> wire = bad_stream(info, 10'000);
    ScanAssembler assembler(info);
    std::uint64_t scans = 0;
    const std::uint64_t before = test::heap_allocations();
    for (const test::Bytes& packet : wire) {
      assembler.push(packet);
      while (assembler.next() != nullptr) ++scans;
    }
    assembler.flush();
    while (assembler.next() != nullptr) ++scans;
    EXPECT_EQ(test::heap_allocations() - before, 0U) << to_string(profile);
    EXPECT_GT(scans, 150U);
    EXPECT_GT(assembler.counters().missing_packets, 0U);
    EXPECT_GT(assembler.counters().duplicate_packets, 0U);
  }
}

}  // namespace
}  // namespace glint
