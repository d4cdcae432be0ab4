// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/imu_packet_writer.hpp"

#include <charconv>

#include "driver/core/bytes.hpp"
#include "driver/core/crc64.hpp"
#include "driver/core/imu_packet_layout.hpp"
#include "driver/core/profile_table.hpp"

namespace glint {
namespace {

void store_vector(std::byte* to, const Eigen::Vector3d& vector) {
  for (const double value : vector) {
    store(to, static_cast<float>(value));
    to += sizeof(float);
  }
}

void write_legacy(const ImuSample& sample, std::int64_t excess_ns, std::byte* to) {
  store(to, sample.accel_time.ns + excess_ns);
  store(to + kLegacyImuAccelTimeOffset, sample.accel_time.ns + excess_ns);
  store(to + kLegacyImuGyroTimeOffset, sample.gyro_time.ns + excess_ns);
  store_vector(to + kLegacyImuAccelerationOffset, sample.acceleration_mps2 / kStandardGravity_mps2);
  store_vector(to + kLegacyImuAngularRateOffset, sample.angular_rate_radps / kRadiansPerDegree);
}

// 24 bits of init id, then 40 of the serial number.
std::uint64_t identity_word(const SensorInfo& info) {
  std::uint64_t serial = 0;
  const std::string& text = info.serial_number;
  std::from_chars(text.data(), text.data() + text.size(), serial);
  return serial << 24U | (info.init_id & 0xFF'FFFFU);
}

}  // namespace

ImuPacketWriter::ImuPacketWriter(const SensorInfo& info)
    : format_(info),
      identity_(identity_word(info)),
      columns_per_frame_(info.columns_per_frame),
      packets_per_frame_(info.imu_packets_per_frame) {}

void ImuPacketWriter::write(std::span<const ImuSample> samples, std::uint16_t frame_id, int index,
                            std::vector<std::byte>& out) const {
  out.assign(format_.packet_bytes, std::byte{0});
  if (format_.profile == ImuProfile::kLegacy) {
    write_legacy(samples.front(), format_.stamp_excess_ns, out.data());
  } else {
    write_nmea(samples, frame_id, index, out);
  }
}

void ImuPacketWriter::write_nmea(std::span<const ImuSample> samples, std::uint16_t frame_id,
                                 int index, std::vector<std::byte>& out) const {
  std::byte* const packet = out.data();
  store(packet, kImuPacketType);
  store(packet + kStandardHeader.frame_id_offset, frame_id);
  store(packet + kStandardHeader.init_id_offset, identity_);
  std::byte* to = packet + kImuHeaderBytes + kImuNmeaBytes;
  int measurement = index * format_.measurements;
  for (const ImuSample& sample : samples) {
    store(to + kImuTimeOffset, sample.accel_time.ns + format_.stamp_excess_ns);
    // Ids are those of the lidar columns that are measured at the same time.
    const int column =
        measurement * columns_per_frame_ / (packets_per_frame_ * format_.measurements);
    store(to + kImuMeasurementIdOffset, static_cast<std::uint16_t>(column));
    store(to + kImuStatusOffset, std::uint16_t{1});
    store_vector(to + kImuAccelerationOffset, sample.acceleration_mps2);
    store_vector(to + kImuAngularRateOffset, sample.angular_rate_radps);
    to += kImuMeasurementBytes;
    ++measurement;
  }
  const std::span covered(packet, out.size() - kImuCrcBytes);
  store(packet + covered.size(), crc64(covered));
}

}  // namespace glint
