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

// Also with losses, disorder, duplicates and a restart: none of them may cost an allocation.
TEST_F(Allocation, TenThousandPacketsCauseNone) {
  for (const auto profile : {LidarProfile::kLegacy, LidarProfile::kRng19Rfl8Sig16Nir16}) {
    SensorInfo info = test::make_sensor(profile, 64, 1024);
    std::mt19937 random(8);
    std::vector<test::Bytes> wire;
    for (std::uint16_t id = 0; wire.size() < 10'000; ++id) {
      if (id == 100) ++info.init_id;
      for (test::Bytes& packet : test::encode(info, test::random_scan(info, id, random))) {
        if (random() % 100 == 0) continue;
        if (random() % 100 == 0) wire.push_back(packet);
        wire.push_back(std::move(packet));
        if (random() % 20 == 0)
          std::swap(wire.back(),
                    wire[wire.size() - 1 - random() % std::min<std::size_t>(wire.size(), 6)]);
      }
    }
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
  }
}

}  // namespace
}  // namespace glint
