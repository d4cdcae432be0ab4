// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/test_box_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "driver/core/packet_format.hpp"
#include "driver/core/xyz_lut.hpp"

namespace glint::test {
namespace {

constexpr int kColumns = 512;

/// To where a ray from inside the room leaves it.
double way_out_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& ray) {
  double way_m = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray[axis] == 0.0) continue;
    const double wall_m = std::copysign(kRoomHalf_m[axis], ray[axis]);
    way_m = std::min(way_m, (wall_m - from_m[axis]) / ray[axis]);
  }
  return way_m;
}

std::array<double, 3> distances_from_walls(const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d away_m = (point_m.cwiseAbs() - kRoomHalf_m).cwiseAbs();
  std::array<double, 3> sorted{away_m.x(), away_m.y(), away_m.z()};
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

}  // namespace

SensorInfo room_sensor(std::vector<double> altitude_deg) {
  SensorInfo info;
  const auto rows = static_cast<int>(altitude_deg.size());
  info.profile = LidarProfile::kLegacy;
  info.pixels_per_column = rows;
  info.columns_per_frame = kColumns;
  info.columns_per_packet = 16;
  info.column_window = {0, kColumns - 1};
  info.beam_altitude_deg = std::move(altitude_deg);
  for (int row = 0; row < rows; ++row) {
    info.pixel_shift_by_row.push_back(3 * (row % 4));
    info.beam_azimuth_deg.push_back(-info.pixel_shift_by_row.back() * 360.0 / kColumns);
  }
  return info;
}

SensorInfo room_sensor() {
  std::vector<double> altitude_deg;
  altitude_deg.reserve(32);
  for (int row = 0; row < 32; ++row) altitude_deg.push_back(35.0 - 70.0 * row / 31.0);
  return room_sensor(std::move(altitude_deg));
}

LidarScan scan_room(const SensorInfo& info, const Pose& T_room_sensor, SensorTime time) {
  LidarScan scan{PacketFormat(info)};
  const XyzLut lut(info);
  for (int m = 0; m < kColumns; ++m) {
    const auto i = static_cast<std::size_t>(m);
    scan.column_time[i] = time + info.scan_period_ns() * m / kColumns;
    for (int row = 0; row < info.pixels_per_column; ++row) {
      // The beam's origin is taken in: two points of the ray, and the way on from the first.
      const Eigen::Vector3d near_m = T_room_sensor * lut.point(row, m, 1'000);
      const Eigen::Vector3d ray = T_room_sensor * lut.point(row, m, 2'000) - near_m;
      scan.range_mm(row, m) =
          static_cast<std::uint32_t>(std::lround(1'000.0 * (1.0 + way_out_m(near_m, ray))));
      scan.signal(row, m) = 100;
    }
  }
  scan.columns_received = scan.columns_expected = kColumns;
  return scan;
}

double distance_from_room(const Eigen::Vector3d& point_m) {
  return distances_from_walls(point_m)[0];
}

double distance_from_edges(const Eigen::Vector3d& point_m) {
  const auto away_m = distances_from_walls(point_m);
  return std::hypot(away_m[0], away_m[1]);
}

}  // namespace glint::test
