// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Restarts of the sensor and frame ids that do not go on.
#include <gtest/gtest.h>

#include "driver/core/bytes.hpp"
#include "driver/core/test_stream.hpp"

namespace glint {
namespace {

using test::Bytes;
using test::encode;
using test::make_sensor;
using test::Stream;

class SensorRestartTest : public test::AssemblerTest {};

TEST_F(SensorRestartTest, RestartWithANewInitIdBeginsANewNumbering) {
  Stream stream(info);
  const auto before = packets(700);
  stream.push_all(packets(699));
  stream.push_all({before.begin(), before.begin() + 5});
  info.init_id += 1;
  stream.push_all(packets(0));
  ASSERT_EQ(stream.scans.size(), 3U);
  EXPECT_EQ(stream.scans[1].columns_received, 80) << "the open scan leaves as it is";
  EXPECT_FALSE(stream.scans[1].sensor_restarted);
  EXPECT_TRUE(stream.scans[2].sensor_restarted);
  EXPECT_EQ(stream.scans[2].frame_id, 0);
  EXPECT_EQ(stream.scans[2].sequence, 701U);
  EXPECT_EQ(stream.counters().restarts, 1U);
  stream.push(before[6]);
  EXPECT_EQ(stream.counters().late_packets, 1U) << "overtaken by the restart";
  stream.push_all(packets(1));
  EXPECT_EQ(stream.scans.back().sequence, 702U);
  EXPECT_FALSE(stream.scans.back().sensor_restarted);
}

TEST_F(SensorRestartTest, MetadataOfAnotherInitIdIsNoRestart) {
  Stream stream(info);
  info.init_id += 1;
  stream.push_all(packets(3));
  EXPECT_EQ(stream.counters().restarts, 0U);
  EXPECT_EQ(stream.scans.size(), 1U);
}

// Legacy packets have no init id: the ids alone tell.
TEST_F(SensorRestartTest, LegacyRestartLosesTwoPacketsAndNotTheStream) {
  info = make_sensor(LidarProfile::kLegacy, 16, kColumns);
  for (const std::uint32_t id_before : {9000U, 50'000U}) {
    Stream stream(info);
    stream.push_all(packets(id_before));
    for (std::uint32_t id = 10; id < 15; ++id) stream.push_all(packets(id));
    ASSERT_EQ(stream.scans.size(), 6U);
    EXPECT_EQ(stream.counters().stray_packets, 2U);
    EXPECT_EQ(stream.counters().restarts, 1U);
    EXPECT_EQ(stream.counters().late_packets + stream.counters().missing_packets, 0U);
    EXPECT_EQ(stream.scans[1].frame_id, 10);
    EXPECT_EQ(stream.scans[1].columns_received, kColumns - 32);
    EXPECT_EQ(stream.scans[1].sequence, id_before + 1U);
    EXPECT_TRUE(stream.scans[1].sensor_restarted);
    EXPECT_FALSE(stream.scans[2].sensor_restarted);
  }
}

// Ids that fall back a little are those of late packets, until there are no others.
TEST_F(SensorRestartTest, LegacyRestartSoonAfterTheLastCostsAScan) {
  info = make_sensor(LidarProfile::kLegacy, 16, kColumns);
  Stream stream(info);
  for (std::uint32_t id = 0; id < 8; ++id) stream.push_all(packets(id));
  for (std::uint32_t id = 0; id < 4; ++id) stream.push_all(packets(id));
  EXPECT_EQ(stream.counters().restarts, 1U);
  EXPECT_EQ(stream.counters().late_packets, kPackets - 1U);
  EXPECT_EQ(stream.counters().packets + stream.counters().late_packets, 12U * kPackets);
}

TEST_F(SensorRestartTest, DoubledDamagedFrameIdIsNoRestart) {
  Stream stream(info);
  stream.push_all(packets(7));
  auto wire = packets(8);
  store<std::uint16_t>(wire[3].data() + 2, 20'007);
  wire.insert(wire.begin() + 4, Bytes(wire[3]));
  stream.push_all(wire);
  stream.push_all(packets(9));
  EXPECT_EQ(stream.counters().restarts, 0U);
  EXPECT_EQ(stream.counters().stray_packets, 2U);
  EXPECT_EQ(stream.counters().missing_packets, 1U);
}

// Without CRCs to tell, a damaged init id passes for a restart; the stream recovers.
TEST_F(SensorRestartTest, StreamRecoversFromADamagedInitId) {
  Stream stream(info);
  stream.push_all(packets(7));
  auto wire = packets(8);
  wire[3][4] ^= std::byte{0x40};
  stream.push_all(wire);
  for (std::uint32_t id = 9; id < 13; ++id) stream.push_all(packets(id));
  EXPECT_EQ(stream.scans.back().frame_id, 12);
  EXPECT_EQ(stream.scans.back().completeness(), 1.0);
  EXPECT_EQ(stream.counters().late_packets, kPackets);
}

// What the sensor did not send before its restart, or before it was listened to, is not missing.
TEST_F(SensorRestartTest, OnlyPacketsBetweenOthersAreMissing) {
  Stream stream(info);
  const auto first = packets(7);
  stream.push_all({first.begin() + 10, first.end()});
  stream.push_all(packets(8));
  auto cut = packets(10);  // and nothing of 9
  stream.push_all({cut.begin(), cut.begin() + 5});
  stream.push(cut[7]);
  info.init_id += 1;
  stream.push_all(packets(0));
  EXPECT_EQ(stream.counters().missing_packets, kPackets + 2U);
  EXPECT_EQ(stream.scans.size(), 4U);
}

// A scan that left in a silence lacks its end as soon as something comes after it.
TEST_F(SensorRestartTest, TheEndOfAScanCutBySilenceIsMissingOnceItGoesOn) {
  Stream stream(info);
  const auto cut = packets(7);
  stream.push_all({cut.begin(), cut.begin() + 20});
  stream.flush();
  EXPECT_EQ(stream.counters().missing_packets, 0U);
  const auto next = packets(9);
  stream.push_all({next.begin() + 2, next.end()});
  stream.flush();
  EXPECT_EQ(stream.counters().missing_packets, 12U + kPackets + 2U);
}

TEST_F(SensorRestartTest, DamagedFrameIdDoesNotMakeTheRestLate) {
  Stream stream(info);
  auto wire = packets(7);
  store<std::uint16_t>(wire[3].data() + 2, 20'007);
  stream.push_all(wire);
  for (std::uint32_t id = 8; id < 11; ++id) stream.push_all(packets(id));
  EXPECT_EQ(stream.scans.size(), 4U);
  EXPECT_EQ(stream.counters().stray_packets, 1U);
  EXPECT_EQ(stream.counters().late_packets, 0U);
}

TEST_F(SensorRestartTest, StreamGoesOnAfterALongSilence) {
  Stream stream(info);
  stream.push_all(packets(7));
  stream.push_all(packets(7000));
  ASSERT_EQ(stream.scans.size(), 2U);
  EXPECT_EQ(stream.scans[1].sequence, 7000U);
  EXPECT_EQ(stream.counters().stray_packets, 0U);
  EXPECT_EQ(stream.counters().missing_packets, 6992U * kPackets);
}

}  // namespace
}  // namespace glint
