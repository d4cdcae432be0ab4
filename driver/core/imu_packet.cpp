// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/imu_packet.hpp"

#include <algorithm>
#include <cstdint>

#include "driver/core/bytes.hpp"
#include "driver/core/imu_packet_layout.hpp"
#include "driver/core/packet_fields.hpp"
#include "driver/core/packet_format.hpp"

namespace glint {
namespace {

// At most 2^62 ns (146 years), so that differences and small steps from it cannot overflow.
SensorTime load_time(const std::byte* from) {
  constexpr std::uint64_t kLatest_ns = 1ULL << 62U;
  return {static_cast<std::int64_t>(std::min(load<std::uint64_t>(from), kLatest_ns))};
}

Eigen::Vector3d load_vector(const std::byte* from) {
  return {load<float>(from), load<float>(from + 4), load<float>(from + 8)};
}

bool finite(const ImuSample& sample) {
  return sample.acceleration_mps2.allFinite() && sample.angular_rate_radps.allFinite();
}

bool parse_nmea_packet(const ImuPacketFormat& format, std::span<const std::byte> bytes,
                       std::vector<ImuSample>& samples, CrcCheck crc) {
  if (bytes.size() != format.packet_bytes) return false;
  if (load<std::uint16_t>(bytes.data()) != kImuPacketType) return false;
  if (crc == CrcCheck::kRequired && !packet_crc_matches(bytes)) return false;
  const std::byte* from = bytes.data() + kImuHeaderBytes + kImuNmeaBytes;
  for (int i = 0; i < format.measurements; ++i, from += kImuMeasurementBytes) {
    if ((load<std::uint16_t>(from + kImuStatusOffset) & 1U) == 0) continue;
    const SensorTime time = load_time(from + kImuTimeOffset) + -format.stamp_excess_ns;
    const ImuSample sample{time, time, load_vector(from + kImuAccelerationOffset),
                           load_vector(from + kImuAngularRateOffset)};
    if (finite(sample)) samples.push_back(sample);
  }
  return true;
}

}  // namespace

ImuPacketFormat::ImuPacketFormat(const SensorInfo& info)
    : profile(info.imu_profile),
      measurements(1),
      packet_bytes(kLegacyImuPacketBytes),
      stamp_excess_ns(info.stamp_excess_ns()) {
  if (profile == ImuProfile::kLegacy) return;
  measurements = info.imu_measurements_per_packet;
  packet_bytes = kImuHeaderBytes + kImuNmeaBytes +
                 static_cast<std::size_t>(measurements) * kImuMeasurementBytes + kImuFooterBytes;
}

bool parse_imu_packet(const ImuPacketFormat& format, std::span<const std::byte> bytes,
                      std::vector<ImuSample>& samples, CrcCheck crc) {
  if (format.profile != ImuProfile::kLegacy) return parse_nmea_packet(format, bytes, samples, crc);
  auto sample = parse_legacy_imu(bytes);
  if (!sample) return false;
  sample->accel_time.ns -= format.stamp_excess_ns;
  sample->gyro_time.ns -= format.stamp_excess_ns;
  samples.push_back(*sample);
  return true;
}

std::optional<ImuSample> parse_legacy_imu(std::span<const std::byte> bytes) {
  if (bytes.size() != kLegacyImuPacketBytes) return std::nullopt;
  const std::byte* packet = bytes.data();
  const ImuSample sample{load_time(packet + kLegacyImuAccelTimeOffset),
                         load_time(packet + kLegacyImuGyroTimeOffset),
                         kStandardGravity_mps2 * load_vector(packet + kLegacyImuAccelerationOffset),
                         kRadiansPerDegree * load_vector(packet + kLegacyImuAngularRateOffset)};
  if (!finite(sample)) return std::nullopt;
  return sample;
}

}  // namespace glint
