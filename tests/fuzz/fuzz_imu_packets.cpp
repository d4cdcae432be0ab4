// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// Datagrams as IMU packets of either profile.
#include "driver/core/imu_packet.hpp"
#include "driver/core/test_sensor.hpp"
#include "tests/fuzz/byte_feed.hpp"
#include "tests/fuzz/require.hpp"

namespace {

using glint::fuzz::require;

constexpr std::int64_t kLatest_ns = std::int64_t{1} << 62U;

void check(const glint::ImuSample& sample) {
  require(sample.acceleration_mps2.allFinite(), "accelerations are finite");
  require(sample.angular_rate_radps.allFinite(), "angular rates are finite");
  require(sample.accel_time.ns >= 0 && sample.accel_time.ns <= kLatest_ns, "times are in range");
  require(sample.gyro_time.ns >= 0 && sample.gyro_time.ns <= kLatest_ns, "times are in range");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  glint::fuzz::ByteFeed feed(glint::fuzz::as_bytes(data, size));
  glint::SensorInfo info =
      glint::test::make_sensor(glint::LidarProfile::kRng19Rfl8Sig16Nir16, 1, 16);
  const unsigned options = feed.byte();
  if ((options & 1U) != 0) info.imu_profile = glint::ImuProfile::kAccel32Gyro32Nmea;
  info.imu_measurements_per_packet = 1 + static_cast<int>(options >> 4U);
  const auto crc = (options & 2U) != 0 ? glint::CrcCheck::kRequired : glint::CrcCheck::kNone;

  const glint::ImuPacketFormat format(info);
  std::vector<glint::ImuSample> samples;
  while (!feed.empty()) {
    const std::size_t before = samples.size();
    // Of the right size, and once what is left.
    const auto bytes = feed.bytes(format.packet_bytes);
    const bool taken = glint::parse_imu_packet(format, bytes, samples, crc);
    require(!taken || bytes.size() == format.packet_bytes, "only the right size is taken");
    require(taken || samples.size() == before, "nothing is appended of what is refused");
    require(samples.size() - before <= static_cast<std::size_t>(format.measurements),
            "no more measurements than the packet holds");
    if (const auto legacy = glint::parse_legacy_imu(bytes)) check(*legacy);
  }
  for (const glint::ImuSample& sample : samples) check(sample);
  return 0;
}
