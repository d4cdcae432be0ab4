// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/imu_packet.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "driver/core/bytes.hpp"

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

TEST(ImuPacket, AnotherSizeIsRejected) {
  const auto packet = make_packet(0.0F);
  EXPECT_FALSE(parse_legacy_imu(std::span(packet).first(47)));
  EXPECT_FALSE(parse_legacy_imu({}));
}

TEST(ImuPacket, NonFiniteValuesAreRejected) {
  EXPECT_FALSE(parse_legacy_imu(make_packet(std::numeric_limits<float>::quiet_NaN())));
  EXPECT_FALSE(parse_legacy_imu(make_packet(std::numeric_limits<float>::infinity())));
}

}  // namespace
}  // namespace glint
