// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// An assembler whose sensor restarts, is replaced, or changes its mode.
#include <gtest/gtest.h>

#include "driver/core/scan_assembler.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

using test::Bytes;
using test::encode;
using test::make_sensor;

class SensorChangeTest : public testing::Test {
 protected:
  std::vector<Bytes> packets(const SensorInfo& info, std::uint16_t frame_id) {
    return encode(info, test::random_scan(info, frame_id, random_));
  }
  void push(const std::vector<Bytes>& packets) {
    for (const Bytes& packet : packets) static_cast<void>(assembler_.push(packet));
  }

  std::mt19937 random_{5};
  const SensorInfo info_ = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 16, 512);
  ScanAssembler assembler_{info_};
};

TEST_F(SensorChangeTest, ASensorOfItsKindIsTakenWithItsIdentity) {
  SensorInfo other = info_;
  other.serial_number = "122201000111";
  push(packets(other, 0));
  EXPECT_EQ(assembler_.counters().bad_serial, 32U);
  assembler_.set_identity(other);
  push(packets(other, 1));
  EXPECT_EQ(assembler_.counters().bad_serial, 32U);
  ASSERT_NE(assembler_.next(), nullptr);
}

TEST_F(SensorChangeTest, IdentityAloneLeavesAnOpenScanAsItIs) {
  auto scan = packets(info_, 0);
  const Bytes last = scan.back();
  scan.pop_back();
  push(scan);
  assembler_.set_identity(info_);
  push({last});
  const LidarScan* whole = assembler_.next();
  ASSERT_NE(whole, nullptr);
  EXPECT_EQ(whole->completeness(), 1.0);
}

TEST_F(SensorChangeTest, AnotherLayoutCountsAndNumbersOn) {
  push(packets(info_, 7));
  const std::uint64_t first = assembler_.next()->sequence;
  const SensorInfo finer = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 32, 1024);
  assembler_.change_sensor(finer);
  EXPECT_EQ(assembler_.format().columns_per_frame, 1024);
  push(packets(finer, 0));
  const LidarScan* scan = assembler_.next();
  ASSERT_NE(scan, nullptr);
  EXPECT_EQ(scan->completeness(), 1.0);
  EXPECT_TRUE(scan->sensor_restarted);
  EXPECT_EQ(scan->sequence, first + 1);
  EXPECT_EQ(assembler_.counters().scans, 2U);
  EXPECT_EQ(assembler_.counters().packets, 32U + 64U);
}

}  // namespace
}  // namespace glint
