// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/sensor_defaults.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

namespace glint {
namespace {

bool is_line(const SensorInfo& info, std::string_view line) {
  return info.product_line.starts_with(line);
}

// The first generation was the OS1 with firmware 1.x; its barest metadata names neither.
bool first_generation(const SensorInfo& info) {
  return firmware_major(info) <= 1 && (info.product_line.empty() || is_line(info, "OS-1"));
}

// The optics were rebuilt with the sensors that firmware 3 brought.
bool rebuilt_generation(const SensorInfo& info) { return firmware_major(info) >= 3; }

Eigen::Matrix4d translation_mm(double x, double y, double z) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topRightCorner<3, 1>() = Eigen::Vector3d(x, y, z);
  return matrix;
}

}  // namespace

int firmware_major(const SensorInfo& info) {
  std::string_view text = info.firmware;
  if (text.starts_with('v')) text.remove_prefix(1);
  int major = 0;
  std::from_chars(text.data(), text.data() + text.size(), major);
  return major;
}

double default_beam_origin_mm(const SensorInfo& info) {
  if (first_generation(info)) return 12.163;
  if (is_line(info, "OS-0")) return 27.67;
  if (is_line(info, "OS-2")) return 13.762;
  return 15.806;
}

Eigen::Matrix4d default_lidar_to_sensor(const SensorInfo& info) {
  const double height_mm = is_line(info, "OS-2")      ? 78.296
                           : rebuilt_generation(info) ? 38.195
                                                      : 36.18;
  Eigen::Matrix4d matrix = translation_mm(0.0, 0.0, height_mm);
  // Half a turn: the lidar frame's x points to the connector, the sensor frame's away from it.
  matrix(0, 0) = matrix(1, 1) = -1.0;
  return matrix;
}

Eigen::Matrix4d default_imu_to_sensor(const SensorInfo& info) {
  return rebuilt_generation(info) ? translation_mm(-2.441, -9.725, 7.533)
                                  : translation_mm(6.253, -11.775, 7.645);
}

std::vector<int> default_pixel_shifts(const SensorInfo& info) {
  std::vector<int> shifts;
  const int columns = info.columns_per_frame;
  const std::size_t rows = info.beam_azimuth_deg.size();
  for (std::size_t r = 0; r < rows; ++r) {
    if (rows == 64) {
      // 18, 12, 6, 0 columns of 1024, repeating every four rows.
      shifts.push_back(static_cast<int>(3 - r % 4) * 6 * columns / 1024);
    } else {
      shifts.push_back(static_cast<int>(std::lround(info.beam_azimuth_deg[r] * columns / 360.0)));
    }
  }
  return shifts;
}

}  // namespace glint
