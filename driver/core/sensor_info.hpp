// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "driver/core/clock_source.hpp"
#include "driver/core/error.hpp"
#include "driver/core/profile_layout.hpp"

namespace glint {

/// All lidar profiles, in the order of LidarProfile.
std::span<const LidarProfile> lidar_profiles();

/// The profile's name as sensors spell it, e.g. "RNG19_RFL8_SIG16_NIR16".
std::string_view to_string(LidarProfile profile);

/// What an IMU packet holds (sensor manual, "IMU data packet format").
enum class ImuProfile {
  kLegacy,             ///< One measurement a packet, at 100 Hz.
  kAccel32Gyro32Nmea,  ///< Several a packet, in step with the lidar's frames (firmware 3.2 on).
};

/// The profile's name as sensors spell it, e.g. "ACCEL32_GYRO32_NMEA".
std::string_view to_string(ImuProfile profile);

/// What a sensor says of itself, from either form of its metadata: the flat one of firmware 1.x/2.0
/// or the grouped one of later firmware. Immutable after parsing; safe to share between threads.
struct SensorInfo {
  std::string product_line;   ///< e.g. "OS-1-64"; empty when the metadata does not say.
  std::string serial_number;  ///< Decimal digits; empty when the metadata does not say.
  std::string firmware;       ///< build_rev, e.g. "v2.3.0"; may be empty.
  std::string lidar_mode;     ///< e.g. "1024x10".
  std::uint32_t init_id = 0;  ///< Initialization id; 0 when unknown.

  LidarProfile profile = LidarProfile::kLegacy;
  PacketHeader header =
      PacketHeader::kStandard;  ///< As metadata has it; packets may prove it wrong.
  int columns_per_frame = 0;    ///< W: 512, 1024, 2048, ...
  int columns_per_packet = 0;   ///< Usually 16.
  int pixels_per_column = 0;    ///< H: beams.
  double scan_rate_hz = 10.0;   ///< From lidar_mode.
  /// First and last column of the azimuth window (measurement ids); first > last when it wraps.
  std::pair<int, int> column_window{0, 0};
  /// Columns by which row r of a staggered scan is shifted right to destagger it; H entries.
  std::vector<int> pixel_shift_by_row;

  std::vector<double> beam_altitude_deg;  ///< H entries, row 0 is the top beam.
  std::vector<double> beam_azimuth_deg;   ///< H entries.
  /// Row-major 4x4, translations in mm. beam_to_lidar is built from the beam origin offset when the
  /// metadata has only that; lidar_to_sensor and imu_to_sensor default by generation.
  Eigen::Matrix4d beam_to_lidar = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d lidar_to_sensor = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d imu_to_sensor = Eigen::Matrix4d::Identity();

  ImuProfile imu_profile = ImuProfile::kLegacy;
  // Legacy packets hold one measurement and come at their own rate, so neither counts for them.
  int imu_measurements_per_packet = 8;
  int imu_packets_per_frame = 8;

  /// What sets the sensor's clock; the oscillator when the metadata does not say.
  ClockSource clock = ClockSource::kInternal;
  /// TAI minus UTC, s: what a user wants to be taken off the stamps of a PTP clock. Not in
  /// metadata.
  int tai_utc_offset_s = 0;

  int lidar_port = 7502;  ///< UDP destination port of lidar packets; 7502 when not said.
  int imu_port = 7503;    ///< UDP destination port of IMU packets; 7503 when not said.

  /// Things a user should know but that do not stop anything, one sentence each.
  std::vector<std::string> warnings;

  /// What is subtracted from every stamp on the wire, of lidar columns and IMU measurements, ns.
  [[nodiscard]] std::int64_t stamp_excess_ns() const {
    constexpr std::int64_t kSecond_ns = 1'000'000'000;
    return clock == ClockSource::kPtp ? tai_utc_offset_s * kSecond_ns : 0;
  }
  /// Nominal time between two scans, ns.
  [[nodiscard]] std::int64_t scan_period_ns() const {
    return static_cast<std::int64_t>(1e9 / scan_rate_hz);
  }
};

/// Reads metadata JSON. `name` (a file, a host) is used in messages.
/// @throws MetadataError with one sentence that names the offending key.
SensorInfo parse_sensor_info(std::string_view json, std::string_view name);

/// Reads a metadata file. @throws MetadataError, also when the file cannot be read.
SensorInfo load_sensor_info(const std::filesystem::path& file);

/// Grouped-form metadata JSON that parse_sensor_info reads back to an equal value.
std::string to_metadata_json(const SensorInfo& info);

}  // namespace glint
