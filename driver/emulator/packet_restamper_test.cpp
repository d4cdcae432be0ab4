// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/packet_restamper.hpp"

#include <gtest/gtest.h>

#include "driver/core/imu_packet_writer.hpp"
#include "driver/core/packet_view.hpp"
#include "driver/core/packet_writer.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint::emulator {
namespace {

using glint::test::Bytes;

constexpr PacketStamp kStamp{-123'456'789, 65'530, 0xABCDEF};

class EveryProfileTest : public testing::TestWithParam<LidarProfile> {};

INSTANTIATE_TEST_SUITE_P(Profiles, EveryProfileTest, testing::ValuesIn(lidar_profiles()),
                         [](const auto& param) { return std::string(to_string(param.param)); });

// Encodes two scans that differ in nothing but what a stamp changes.
TEST_P(EveryProfileTest, ARestampedPacketIsThatOfTheOtherMoment) {
  SensorInfo info = glint::test::make_sensor(GetParam(), 16, 512);
  std::mt19937 random(3);
  LidarScan scan = glint::test::random_scan(info, 9, random);
  const std::vector<Bytes> recorded = glint::test::encode(info, scan);
  scan.frame_id += kStamp.frame_shift;
  for (SensorTime& time : scan.column_time) time = time + kStamp.time_shift_ns;
  info.init_id = kStamp.init_id;
  const std::vector<Bytes> expected = glint::test::encode(info, scan);

  const PacketRestamper restamper(PacketFormat{info}, ImuPacketFormat{info}, true);
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    Bytes packet = recorded[i];
    ASSERT_TRUE(restamper.restamp_lidar(packet, kStamp));
    ASSERT_EQ(packet, expected[i]) << i;
  }
}

TEST(PacketRestamper, IdsOfThirtyTwoBitsKeepThem) {
  SensorInfo info = glint::test::make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 16, 512);
  info.header = PacketHeader::kFusa;
  std::mt19937 random(3);
  LidarScan scan = glint::test::random_scan(info, 9, random);
  scan.frame_id = 70'000;
  Bytes packet = glint::test::encode(info, scan).front();
  const PacketFormat format(info);
  const PacketRestamper restamper(format, ImuPacketFormat{info}, true);
  ASSERT_TRUE(restamper.restamp_lidar(packet, {0, 5, 0}));
  const auto view = PacketView::parse(format, packet);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->frame_id(), 70'005U);
  EXPECT_EQ(view->init_id(), info.init_id) << "0 leaves it";
  EXPECT_TRUE(view->crc_matches());
}

TEST(PacketRestamper, AWrongCrcStaysAsItIs) {
  const SensorInfo info = glint::test::make_sensor(LidarProfile::kRng15Rfl8Nir8, 16, 512);
  std::mt19937 random(3);
  Bytes packet = glint::test::encode(info, glint::test::random_scan(info, 9, random)).front();
  std::fill(packet.end() - 8, packet.end(), std::byte{0});
  const PacketRestamper restamper(PacketFormat{info}, ImuPacketFormat{info}, false);
  ASSERT_TRUE(restamper.restamp_lidar(packet, kStamp));
  EXPECT_TRUE(std::all_of(packet.end() - 8, packet.end(), [](auto b) { return b == std::byte{}; }));
}

TEST(PacketRestamper, ImuPacketsOfBothProfilesAreMoved) {
  for (const ImuProfile profile : {ImuProfile::kLegacy, ImuProfile::kAccel32Gyro32Nmea}) {
    SensorInfo info = glint::test::make_sensor(LidarProfile::kRng15Rfl8Nir8, 16, 512);
    info.imu_profile = profile;
    const ImuPacketFormat format(info);
    std::vector<ImuSample> samples(static_cast<std::size_t>(format.measurements));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const SensorTime time{1'000'000'000'000 + static_cast<std::int64_t>(i) * 1'250'000};
      samples[i] = {time, time, {0.1, 0.2, 9.8}, {0.01, 0.02, 0.03}};
    }
    const auto write = [&](std::uint16_t frame_id) {
      Bytes packet;
      ImuPacketWriter(info).write(samples, frame_id, 1, packet);
      return packet;
    };
    Bytes packet = write(9);
    const PacketRestamper restamper(PacketFormat(info), format, true);
    ASSERT_TRUE(restamper.restamp_imu(packet, kStamp));
    for (ImuSample& sample : samples) {
      sample.accel_time = sample.accel_time + kStamp.time_shift_ns;
      sample.gyro_time = sample.accel_time;
    }
    info.init_id = kStamp.init_id;
    EXPECT_EQ(packet, write(static_cast<std::uint16_t>(9 + kStamp.frame_shift)));
  }
}

TEST(PacketRestamper, OtherSizesAreLeftAlone) {
  const SensorInfo info = glint::test::make_sensor(LidarProfile::kRng15Rfl8Nir8, 16, 512);
  const PacketRestamper restamper(PacketFormat{info}, ImuPacketFormat{info}, true);
  Bytes none;
  EXPECT_FALSE(restamper.restamp_lidar(none, kStamp));
  Bytes other(47, std::byte{7});
  EXPECT_FALSE(restamper.restamp_imu(other, kStamp));
  EXPECT_EQ(other, Bytes(47, std::byte{7}));
}

TEST(PacketRestamper, AnotherSensorsPacketDiffersInItsSerialNumberOnly) {
  const SensorInfo info = glint::test::make_sensor(LidarProfile::kRng15Rfl8Nir8, 16, 512);
  std::mt19937 random(3);
  Bytes packet = glint::test::encode(info, glint::test::random_scan(info, 9, random)).front();
  const PacketFormat format(info);
  const PacketRestamper restamper(format, ImuPacketFormat{info}, true);
  ASSERT_TRUE(restamper.change_serial_number(packet));
  const auto view = PacketView::parse(format, packet);
  EXPECT_NE(std::to_string(view->serial_number()), info.serial_number);
  EXPECT_TRUE(view->crc_matches());
}

}  // namespace
}  // namespace glint::emulator
