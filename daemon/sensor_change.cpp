// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/sensor_change.hpp"

#include <fmt/format.h>

#include <vector>

namespace glint::daemon {
namespace {

std::string window_text(const SensorInfo& info) {
  return fmt::format("[{}, {}]", info.column_window.first, info.column_window.second);
}

/// Measurements a packet and packets a frame; of no meaning for legacy packets.
std::pair<int, int> imu_packing(const SensorInfo& info) {
  if (info.imu_profile == ImuProfile::kLegacy) return {};
  return {info.imu_measurements_per_packet, info.imu_packets_per_frame};
}

bool same_geometry(const SensorInfo& a, const SensorInfo& b) {
  return a.pixel_shift_by_row == b.pixel_shift_by_row &&
         a.beam_altitude_deg == b.beam_altitude_deg && a.beam_azimuth_deg == b.beam_azimuth_deg &&
         a.beam_to_lidar == b.beam_to_lidar && a.lidar_to_sensor == b.lidar_to_sensor &&
         a.imu_to_sensor == b.imu_to_sensor;
}

}  // namespace

std::string stream_change(const SensorInfo& from, const SensorInfo& to) {
  std::vector<std::string> changes;
  const auto compare = [&](const char* what, const auto& a, const auto& b) {
    if (a != b) changes.push_back(fmt::format("{} {} -> {}", what, a, b));
  };
  compare("lidar_mode", from.lidar_mode, to.lidar_mode);
  compare("profile", to_string(from.profile), to_string(to.profile));
  compare("columns a frame", from.columns_per_frame, to.columns_per_frame);
  compare("columns a packet", from.columns_per_packet, to.columns_per_packet);
  compare("beams", from.pixels_per_column, to.pixels_per_column);
  compare("scans a second", from.scan_rate_hz, to.scan_rate_hz);
  compare("column window", window_text(from), window_text(to));
  compare("IMU profile", to_string(from.imu_profile), to_string(to.imu_profile));
  if (imu_packing(from) != imu_packing(to)) changes.emplace_back("packing of IMU packets");
  if (from.header != to.header) changes.emplace_back("header of packets");
  if (!same_geometry(from, to)) changes.emplace_back("geometry of the beams");
  return fmt::format("{}", fmt::join(changes, ", "));
}

}  // namespace glint::daemon
