// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/packet_view.hpp"

#include <gtest/gtest.h>

#include "driver/core/bytes.hpp"
#include "driver/core/packet_writer.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

using test::Bytes;
using test::encode;
using test::make_sensor;
using test::random_scan;

// A legacy packet built byte by byte from the sensor manual, not by PacketWriter: both could share
// a mistake.
TEST(PacketView, LegacyFieldsAreWhereTheManualPutsThem) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, 64, 1024);
  const PacketFormat format(info);
  Bytes packet(12608);
  std::byte* column = packet.data() + 3UL * 788;
  store<std::uint64_t>(column, 123'456'789'012);
  store<std::uint16_t>(column + 8, 515);
  store<std::uint16_t>(column + 10, 65'535);
  std::byte* pixel = column + 16 + 12UL * 7;
  store<std::uint32_t>(pixel, 0x8000'0000U | 0xF'1234U);
  store<std::uint16_t>(pixel + 4, 0xABCD);
  store<std::uint16_t>(pixel + 6, 4321);
  store<std::uint16_t>(pixel + 8, 9876);
  store<std::uint32_t>(column + 784, 0xFFFF'FFFFU);

  const auto view = PacketView::parse(format, packet);
  ASSERT_TRUE(view);
  const ColumnView read = view->column(3);
  EXPECT_EQ(read.time().ns, 123'456'789'012);
  EXPECT_EQ(read.measurement_id(), 515);
  EXPECT_EQ(read.legacy_frame_id(), 65'535);
  EXPECT_TRUE(read.valid());
  EXPECT_FALSE(view->column(4).valid());
  EXPECT_EQ(read.value(Channel::kRange, 7), 0xF'1234U) << "flags are no part of the range";
  EXPECT_EQ(read.value(Channel::kReflectivity, 7), 0xABCDU) << "old firmware's is 16 bits wide";
  EXPECT_EQ(read.value(Channel::kSignal, 7), 4321U);
  EXPECT_EQ(read.value(Channel::kNearIr, 7), 9876U);
  EXPECT_EQ(read.value(Channel::kRange2, 7), 0U);
}

TEST(PacketView, TheOffsetOfTaiIsTakenOffTheStampsOfAPtpClockOnly) {
  SensorInfo info = make_sensor(LidarProfile::kLegacy, 64, 1024);
  info.tai_utc_offset_s = 37;
  Bytes packet(12608);
  store<std::uint64_t>(packet.data(), 37'000'000'005);
  EXPECT_EQ(PacketView::parse(PacketFormat(info), packet)->column(0).time().ns, 37'000'000'005);
  info.clock = ClockSource::kPtp;
  EXPECT_EQ(PacketView::parse(PacketFormat(info), packet)->column(0).time().ns, 5);
  info.tai_utc_offset_s = -60;
  store<std::uint64_t>(packet.data(), ~std::uint64_t{0});
  EXPECT_GT(PacketView::parse(PacketFormat(info), packet)->column(0).time().ns, 0);
}

TEST(PacketView, DualReturnFieldsAreWhereTheManualPutsThem) {
  const PacketFormat format(make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16Dual, 32, 1024));
  Bytes packet(8448);
  store<std::uint16_t>(packet.data(), 1);
  store<std::uint16_t>(packet.data() + 2, 4711);
  store<std::uint32_t>(packet.data() + 4, 0xFE'DCBAU);
  store<std::uint64_t>(packet.data() + 7, 992'137'000'142U);
  std::byte* column = packet.data() + 32 + 2UL * (12 + 32UL * 16);
  store<std::uint16_t>(column + 10, 1);
  std::byte* pixel = column + 12 + 16UL * 5;
  store<std::uint32_t>(pixel, 200U << 24U | 0x1FU << 19U | 300'000U);
  store<std::uint32_t>(pixel + 4, 17U << 24U | 0x1FU << 19U | 524'287U);
  store<std::uint16_t>(pixel + 8, 1001);
  store<std::uint16_t>(pixel + 10, 1002);
  store<std::uint16_t>(pixel + 12, 1003);

  const auto view = PacketView::parse(format, packet);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->frame_id(), 4711);
  EXPECT_EQ(view->init_id(), 0xFE'DCBAU);
  EXPECT_EQ(view->serial_number(), 992'137'000'142U);
  const ColumnView read = view->column(2);
  EXPECT_TRUE(read.valid());
  EXPECT_EQ(read.value(Channel::kRange, 5), 300'000U);
  EXPECT_EQ(read.value(Channel::kReflectivity, 5), 200U);
  EXPECT_EQ(read.value(Channel::kRange2, 5), 524'287U);
  EXPECT_EQ(read.value(Channel::kReflectivity2, 5), 17U);
  EXPECT_EQ(read.value(Channel::kSignal, 5), 1001U);
  EXPECT_EQ(read.value(Channel::kSignal2, 5), 1002U);
  EXPECT_EQ(read.value(Channel::kNearIr, 5), 1003U);
}

TEST(PacketView, LowDataRateValuesAreScaled) {
  const PacketFormat format(make_sensor(LidarProfile::kRng15Rfl8Nir8, 128, 1024));
  Bytes packet(8448);
  store<std::uint16_t>(packet.data(), 1);
  store<std::uint32_t>(packet.data() + 32 + 12, 255U << 24U | 7U << 16U | 0x8000U | 32'767U);
  const auto view = PacketView::parse(format, packet);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->column(0).value(Channel::kRange, 0), 262'136U);
  EXPECT_EQ(view->column(0).value(Channel::kReflectivity, 0), 7U);
  EXPECT_EQ(view->column(0).value(Channel::kNearIr, 0), 4080U);
}

TEST(PacketView, TruncatedPacketIsRejected) {
  const SensorInfo info = make_sensor(LidarProfile::kLegacy, 64, 1024);
  const PacketFormat format(info);
  const Bytes packet(format.packet_bytes);
  for (const std::size_t size : {std::size_t{0}, std::size_t{48}, format.packet_bytes - 1}) {
    PacketError error = PacketError::kNone;
    EXPECT_FALSE(PacketView::parse(format, std::span(packet).first(size), &error));
    EXPECT_EQ(error, PacketError::kSize);
  }
}

TEST(PacketView, AnotherPacketTypeIsRejected) {
  const PacketFormat format(make_sensor(LidarProfile::kRng15Rfl8Nir8, 64, 1024));
  Bytes packet(format.packet_bytes);
  store<std::uint16_t>(packet.data(), 2);
  PacketError error = PacketError::kNone;
  EXPECT_FALSE(PacketView::parse(format, packet, &error));
  EXPECT_EQ(error, PacketError::kType);
}

TEST(PacketView, TimesBeyondTheClocksRangeAreCut) {
  const PacketFormat format(make_sensor(LidarProfile::kLegacy, 16, 512));
  Bytes packet(format.packet_bytes, std::byte{0xFF});
  const SensorTime time = PacketView::parse(format, packet)->column(0).time();
  EXPECT_EQ(time.ns, std::int64_t{1} << 62U);
}

TEST(PacketWriter, WritesWhatPacketViewReads) {
  std::mt19937 random(1);
  for (const auto profile : lidar_profiles()) {
    const SensorInfo info = make_sensor(profile, 16, 512);
    SCOPED_TRACE(to_string(profile));
    const PacketFormat format(info);
    const LidarScan scan = random_scan(info, 54'321, random);
    const Bytes packet = encode(info, scan)[5];
    const auto view = PacketView::parse(format, packet);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->frame_id(), 54'321);
    EXPECT_EQ(view->init_id(), info.init_id);
    EXPECT_EQ(view->serial_number(), format.legacy() ? 0U : 122'201'000'998U);
    const ColumnView column = view->column(3);
    EXPECT_EQ(column.measurement_id(), 83);
    EXPECT_EQ(column.time(), scan.column_time[83]);
    EXPECT_EQ(column.status(), scan.column_status[83]);
    EXPECT_EQ(column.value(Channel::kRange, 9), scan.range_mm(9, 83));
    EXPECT_EQ(column.value(Channel::kReflectivity, 9), scan.reflectivity(9, 83));
    const auto expect_same = [&](Channel channel, const auto& image) {
      EXPECT_EQ(column.value(channel, 9), image.empty() ? 0U : image(9, 83));
    };
    expect_same(Channel::kSignal, scan.signal);
    expect_same(Channel::kNearIr, scan.near_ir);
    expect_same(Channel::kRange2, scan.range2_mm);
    expect_same(Channel::kSignal2, scan.signal2);
    expect_same(Channel::kReflectivity2, scan.reflectivity2);
    EXPECT_EQ(view->crc_matches(), !format.legacy());
  }
}

TEST(PacketView, ADamagedPacketFailsItsCrc) {
  std::mt19937 random(2);
  const SensorInfo info = make_sensor(LidarProfile::kRng15Rfl8Nir8, 16, 512);
  const PacketFormat format(info);
  Bytes packet = encode(info, random_scan(info, 7, random))[3];
  EXPECT_TRUE(PacketView::parse(format, packet)->crc_matches());
  packet[100] ^= std::byte{0x10};
  EXPECT_FALSE(PacketView::parse(format, packet)->crc_matches());
}

// Built byte by byte from the manual.
TEST(PacketView, FusaHeaderFieldsAreWhereTheManualPutsThem) {
  const PacketFormat format(make_sensor(LidarProfile::kFusaRng15Rfl8Nir8Dual, 128, 1024));
  Bytes packet(16640);
  store<std::uint64_t>(packet.data() + 11, 992'137'000'142U);
  store<std::uint32_t>(packet.data() + 1, 0xFE'DCBAU);
  store<std::uint8_t>(packet.data(), 1);
  store<std::uint32_t>(packet.data() + 4, 3'000'000'000U);
  store<std::uint8_t>(packet.data() + 8, 0x83);
  store<std::uint32_t>(packet.data() + 16, 0xF1F1'0705U);
  const auto view = PacketView::parse(format, packet);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->frame_id(), 3'000'000'000U);
  EXPECT_EQ(view->init_id(), 0xFE'DCBAU);
  EXPECT_EQ(view->serial_number(), 992'137'000'142U);
  const PacketHealth health = view->health();
  EXPECT_EQ(health.alert_flags, 0x83);
  EXPECT_EQ(health.thermal_countdown_s, 5);
  EXPECT_EQ(health.shot_limiting_countdown_s, 7);
  EXPECT_EQ(health.thermal_state, 1);
  EXPECT_EQ(health.shot_limiting_state, 1);
}

TEST(PacketView, TheHeaderIsRecognisedByTheSensorsIds) {
  std::mt19937 random(3);
  SensorInfo info = make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 16, 512);
  const std::uint64_t serial = std::stoull(info.serial_number);
  const LidarScan scan = random_scan(info, 77, random);
  for (const PacketHeader header : {PacketHeader::kStandard, PacketHeader::kFusa}) {
    info.header = header;
    const Bytes packet = encode(info, scan)[0];
    EXPECT_EQ(recognise_header(packet, serial, 0), header);
    EXPECT_EQ(recognise_header(packet, 0, info.init_id), header);
    EXPECT_EQ(recognise_header(packet, serial + 1, 0), std::nullopt);
    EXPECT_EQ(recognise_header(packet, 0, 0), std::nullopt);
  }
}

TEST(PacketWriter, WideValuesSaturateAndRangesRoundDown) {
  const SensorInfo info = make_sensor(LidarProfile::kRng15Rfl8Nir8, 16, 512);
  LidarScan scan{PacketFormat(info)};
  scan.range_mm(0, 0) = 1'000'000;
  scan.range_mm(1, 0) = 8U * 1000 + 7;
  scan.reflectivity(0, 0) = 0xABCD;
  scan.near_ir(0, 0) = 60'000;
  const Bytes packet = encode(info, scan)[0];
  const PacketFormat format(info);
  const ColumnView column = PacketView::parse(format, packet)->column(0);
  EXPECT_EQ(column.value(Channel::kRange, 0), 262'136U);
  EXPECT_EQ(column.value(Channel::kRange, 1), 8000U);
  EXPECT_EQ(column.value(Channel::kReflectivity, 0), 255U);
  EXPECT_EQ(column.value(Channel::kNearIr, 0), 4080U);
}

}  // namespace
}  // namespace glint
