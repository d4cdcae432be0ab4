// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/imu_packet.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "driver/core/bytes.hpp"
#include "driver/core/imu_packet_writer.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint {
namespace {

std::array<std::byte, 48> make_packet(float last_rate_degps) {
  std::array<std::byte, 48> packet{};
  store<std::uint64_t>(&packet[0], 5);
  store<std::uint64_t>(&packet[8], 1'000'000'007);
  store<std::uint64_t>(&packet[16], 1'000'000'009);
  const std::array<float, 6> values{0.0F, -0.5F, 1.0F, 90.0F, -180.0F, last_rate_degps};
  for (std::size_t i = 0; i < values.size(); ++i) store(&packet[24 + 4 * i], values[i]);
  return packet;
}

TEST(ImuPacket, UnitsBecomeSiAndTimesAreKeptApart) {
  const auto sample = parse_legacy_imu(make_packet(360.0F));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->accel_time.ns, 1'000'000'007);
  EXPECT_EQ(sample->gyro_time.ns, 1'000'000'009);
  EXPECT_TRUE(sample->acceleration_mps2.isApprox(Eigen::Vector3d(0.0, -4.903325, 9.80665), 1e-9));
  EXPECT_TRUE(
      sample->angular_rate_radps.isApprox(Eigen::Vector3d(M_PI_2, -M_PI, 2.0 * M_PI), 1e-9));
}

TEST(ImuPacket, TheOffsetOfTaiIsTakenOffTheStampsOfAPtpClock) {
  for (const ImuProfile profile : {ImuProfile::kLegacy, ImuProfile::kAccel32Gyro32Nmea}) {
    SensorInfo info = test::make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 32, 1024);
    info.imu_profile = profile;
    const ImuPacketWriter writer(info);
    const SensorTime time{40'000'000'000};
    std::vector<std::byte> packet;
    writer.write(std::vector<ImuSample>(static_cast<std::size_t>(writer.format().measurements),
                                        ImuSample{.accel_time = time, .gyro_time = time}),
                 0, 0, packet);
    info.clock = ClockSource::kPtp;
    info.tai_utc_offset_s = 37;
    std::vector<ImuSample> samples;
    ASSERT_TRUE(parse_imu_packet(ImuPacketFormat(info), packet, samples));
    EXPECT_EQ(samples.front().accel_time.ns, 3'000'000'000);
    EXPECT_EQ(samples.front().gyro_time.ns, 3'000'000'000);
  }
}

TEST(ImuPacket, AnotherSizeIsRejected) {
  const auto packet = make_packet(0.0F);
  EXPECT_FALSE(parse_legacy_imu(std::span(packet).first(47)));
  EXPECT_FALSE(parse_legacy_imu({}));
}

TEST(ImuPacket, NonFiniteValuesAreRejected) {
  EXPECT_FALSE(parse_legacy_imu(make_packet(std::numeric_limits<float>::quiet_NaN())));
  EXPECT_FALSE(parse_legacy_imu(make_packet(std::numeric_limits<float>::infinity())));
}

SensorInfo nmea_sensor() {
  SensorInfo info = test::make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 32, 1024);
  info.imu_profile = ImuProfile::kAccel32Gyro32Nmea;
  return info;
}

// `count` different measurements whose values float32 holds exactly.
std::vector<ImuSample> some_samples(int count) {
  std::vector<ImuSample> samples;
  for (int i = 0; i < count; ++i) {
    const SensorTime time{1'000'000'000 + i * 1'562'500};
    samples.push_back({time, time, {0.5 * i, -1.25, 9.75}, {0.125, -0.5 * i, 0.25}});
  }
  return samples;
}

test::Bytes write_nmea(const std::vector<ImuSample>& samples) {
  test::Bytes packet;
  ImuPacketWriter(nmea_sensor()).write(samples, 4711, 2, packet);
  return packet;
}

// Built byte by byte from the sensor manual, not by ImuPacketWriter: both could share a mistake.
TEST(NmeaImuPacket, FieldsAreWhereTheManualPutsThem) {
  test::Bytes packet(452);
  store<std::uint16_t>(packet.data(), 2);
  std::byte* third = packet.data() + 132 + 2 * 36;
  store<std::uint64_t>(third, 123'456'789'012);
  store<std::uint16_t>(third + 10, 1);
  const std::array<float, 6> values{1.5F, -2.5F, 9.75F, 0.5F, -0.25F, 3.0F};
  for (std::size_t i = 0; i < values.size(); ++i) store(third + 12 + 4 * i, values[i]);

  std::vector<ImuSample> samples;
  ASSERT_TRUE(parse_imu_packet(ImuPacketFormat(nmea_sensor()), packet, samples));
  ASSERT_EQ(samples.size(), 1U) << "the others are not marked valid";
  EXPECT_EQ(samples[0].accel_time.ns, 123'456'789'012);
  EXPECT_EQ(samples[0].gyro_time.ns, 123'456'789'012);
  EXPECT_EQ(samples[0].acceleration_mps2, Eigen::Vector3d(1.5, -2.5, 9.75));
  EXPECT_EQ(samples[0].angular_rate_radps, Eigen::Vector3d(0.5, -0.25, 3.0));
}

TEST(NmeaImuPacket, HeaderAndMeasurementIdsAreWhereTheManualPutsThem) {
  const test::Bytes packet = write_nmea(some_samples(8));
  ASSERT_EQ(packet.size(), 452U);
  EXPECT_EQ(load<std::uint16_t>(packet.data()), 2);
  EXPECT_EQ(load<std::uint16_t>(packet.data() + 2), 4711);
  EXPECT_EQ(load<std::uint32_t>(packet.data() + 4) & 0xFF'FFFFU, 7'109'750U);
  EXPECT_EQ(load<std::uint64_t>(packet.data() + 7) & 0xFF'FFFF'FFFFU, 122'201'000'998U);
  // 64 measurements in the 1024 columns of a frame: every 16th column.
  EXPECT_EQ(load<std::uint16_t>(packet.data() + 132 + 8), 2 * 128);
  EXPECT_EQ(load<std::uint16_t>(packet.data() + 132 + 36 + 8), 2 * 128 + 16);
}

TEST(ImuPacketWriter, WhatItWritesIsReadBackInBothProfiles) {
  for (const ImuProfile profile : {ImuProfile::kLegacy, ImuProfile::kAccel32Gyro32Nmea}) {
    SensorInfo info = nmea_sensor();
    info.imu_profile = profile;
    const ImuPacketWriter writer(info);
    std::vector<ImuSample> samples = some_samples(writer.format().measurements);
    if (profile == ImuProfile::kLegacy) samples[0].gyro_time.ns += 7;
    test::Bytes packet;
    writer.write(samples, 1, 0, packet);
    std::vector<ImuSample> read;
    ASSERT_TRUE(parse_imu_packet(ImuPacketFormat(info), packet, read, CrcCheck::kRequired));
    ASSERT_EQ(read.size(), samples.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      EXPECT_EQ(read[i].accel_time, samples[i].accel_time);
      EXPECT_EQ(read[i].gyro_time, samples[i].gyro_time);
      EXPECT_LT((read[i].acceleration_mps2 - samples[i].acceleration_mps2).norm(), 1e-6);
      EXPECT_LT((read[i].angular_rate_radps - samples[i].angular_rate_radps).norm(), 1e-6);
    }
  }
}

TEST(NmeaImuPacket, CrcCountsOnlyWhereItIsRequired) {
  test::Bytes packet = write_nmea(some_samples(8));
  packet[140] ^= std::byte{1};
  const ImuPacketFormat format(nmea_sensor());
  std::vector<ImuSample> samples;
  EXPECT_FALSE(parse_imu_packet(format, packet, samples, CrcCheck::kRequired));
  EXPECT_TRUE(samples.empty());
  EXPECT_TRUE(parse_imu_packet(format, packet, samples));
  EXPECT_EQ(samples.size(), 8U);
}

TEST(NmeaImuPacket, AnotherSizeOrTypeIsRefused) {
  const test::Bytes packet = write_nmea(some_samples(8));
  const ImuPacketFormat format(nmea_sensor());
  std::vector<ImuSample> samples;
  for (std::size_t size = 0; size < packet.size(); ++size) {
    EXPECT_FALSE(parse_imu_packet(format, std::span(packet).first(size), samples)) << size;
  }
  test::Bytes lidar = packet;
  store<std::uint16_t>(lidar.data(), 1);
  EXPECT_FALSE(parse_imu_packet(format, lidar, samples));
  EXPECT_TRUE(samples.empty());
}

TEST(NmeaImuPacket, NonFiniteMeasurementsAreLeftOut) {
  std::vector<ImuSample> written = some_samples(8);
  written[3].angular_rate_radps.y() = std::numeric_limits<double>::quiet_NaN();
  std::vector<ImuSample> samples;
  ASSERT_TRUE(parse_imu_packet(ImuPacketFormat(nmea_sensor()), write_nmea(written), samples));
  ASSERT_EQ(samples.size(), 7U);
  EXPECT_EQ(samples[3].accel_time, written[4].accel_time);
}

}  // namespace
}  // namespace glint
