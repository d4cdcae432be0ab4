// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor/sensor_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "driver/core/sensor_defaults.hpp"
#include "pcap/synth/option_error.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

struct Optics {
  const char* name;
  const char* product_line;
  double vertical_fov_deg;
  // Four neighbouring beams look +3, +1, -1, -3 times this to the side. First-generation OS1:
  // other.
  double azimuth_step_deg;
};
constexpr std::array<Optics, 3> kOptics = {
    {{"os0", "OS-0", 90.0, 1.41}, {"os1", "OS-1", 45.0, 1.41}, {"os2", "OS-2", 22.5, 0.69}}};
constexpr double kFirstGenerationStepDeg = 1.05;

const Optics& optics_of(const std::string& name) {
  for (const Optics& optics : kOptics) {
    if (name == optics.name) return optics;
  }
  throw OptionError(fmt::format("unknown sensor '{}': choose os0, os1 or os2", name));
}

void require(int value, std::initializer_list<int> possible, const char* what) {
  if (std::find(possible.begin(), possible.end(), value) != possible.end()) return;
  throw OptionError(fmt::format("no such sensor has {} {}: choose one of {}", value, what,
                                fmt::join(possible, ", ")));
}

// Sensors of 16 and 32 beams keep every fourth beam or rarer: all of those look the same way.
double azimuth_deg(const SensorOptions& options, const Optics& optics, int row) {
  if (options.beams < 64) return optics.azimuth_step_deg;
  const bool first_generation =
      options.optics == "os1" && options.beams == 64 && options.profile == LidarProfile::kLegacy;
  const double step_deg = first_generation ? kFirstGenerationStepDeg : optics.azimuth_step_deg;
  return step_deg * (3 - 2 * (row % 4));
}

void set_beams(SensorInfo& info, const SensorOptions& options, const Optics& optics,
               std::uint64_t seed) {
  Random random{seed, 0x5E4504ULL};
  const double spacing_deg = optics.vertical_fov_deg / options.beams;
  for (int row = 0; row < options.beams; ++row) {
    info.beam_altitude_deg.push_back((0.5 * (options.beams - 1) - row) * spacing_deg +
                                     0.05 * spacing_deg * random.gaussian());
    info.beam_azimuth_deg.push_back(azimuth_deg(options, optics, row) + 0.03 * random.gaussian());
  }
  // Firmware before 3 counts the shifts from the beam that looks furthest to the right.
  const double least_deg =
      *std::min_element(info.beam_azimuth_deg.begin(), info.beam_azimuth_deg.end());
  for (const double beam_deg : info.beam_azimuth_deg) {
    info.pixel_shift_by_row.push_back(
        static_cast<int>(std::lround((beam_deg - least_deg) * options.columns / 360.0)));
  }
}

}  // namespace

SensorInfo make_sensor(const SensorOptions& options, std::uint64_t seed) {
  const Optics& optics = optics_of(options.optics);
  require(options.beams, {16, 32, 64, 128}, "beams");
  require(options.columns, {512, 1024, 2048}, "columns");
  require(options.rate_hz, {10, 20}, "scans a second");
  if (options.columns == 2048 && options.rate_hz == 20) {
    throw OptionError(
        "no such sensor makes 20 scans of 2048 columns a second: choose 10 scans, "
        "or 1024 columns");
  }

  const bool legacy = options.profile == LidarProfile::kLegacy;
  if (legacy && options.imu_profile != ImuProfile::kLegacy) {
    throw OptionError("no firmware sends LEGACY lidar packets beside ACCEL32_GYRO32_NMEA ones");
  }
  SensorInfo info;
  info.product_line = fmt::format("{}-{}", optics.product_line, options.beams);
  info.serial_number = fmt::format("{}", 992'100'000'000 + seed % 1'000'000);
  info.firmware = legacy ? "v1.14.0" : "v2.5.2";
  info.lidar_mode = fmt::format("{}x{}", options.columns, options.rate_hz);
  info.init_id = legacy ? 0 : 5'390'293;
  info.profile = options.profile;
  info.columns_per_frame = options.columns;
  info.columns_per_packet = 16;
  info.pixels_per_column = options.beams;
  info.scan_rate_hz = options.rate_hz;
  info.column_window = {0, options.columns - 1};
  set_beams(info, options, optics, seed);
  info.beam_to_lidar(0, 3) = default_beam_origin_mm(info);
  info.lidar_to_sensor = default_lidar_to_sensor(info);
  info.imu_to_sensor = default_imu_to_sensor(info);
  info.imu_profile = options.imu_profile;
  if (options.imu_profile == ImuProfile::kAccel32Gyro32Nmea) {
    // One packet a scan, of measurements at 100 Hz.
    info.imu_packets_per_frame = 1;
    info.imu_measurements_per_packet = 100 / options.rate_hz;
    info.firmware = "v3.2.0";
  }
  return info;
}

}  // namespace glint::synth
