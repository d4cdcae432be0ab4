// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/test_room.hpp"

#include <cmath>
#include <limits>

#include "driver/core/packet_writer.hpp"
#include "driver/core/xyz_lut.hpp"

namespace glint::test {
namespace {

constexpr double kHalfWidthM = 5.0;
constexpr double kHalfHeightM = 2.0;
constexpr double kSpeedMPerScan = 0.05;

/// Distance from `origin` along `direction` to the wall of the box.
double wall_distance_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d half(kHalfWidthM, kHalfWidthM, kHalfHeightM);
  double nearest = std::numeric_limits<double>::max();
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (direction[i] == 0.0) continue;
    const double wall = direction[i] > 0 ? half[i] : -half[i];
    nearest = std::min(nearest, (wall - origin[i]) / direction[i]);
  }
  return nearest;
}

/// Patches of 0.4 m, each with a brightness of its own.
std::uint16_t brightness(const Eigen::Vector3d& point) {
  std::uint32_t hash = 17;
  for (const double x : point) {
    const auto cell = static_cast<std::int32_t>(std::floor(x / 0.4));
    hash = (hash ^ static_cast<std::uint32_t>(cell)) * 2654435761U;
    hash ^= hash >> 15U;
  }
  return static_cast<std::uint16_t>(50 + hash % 900);
}

LidarScan scan_of_room(const SensorInfo& info, const XyzLut& lut, int k) {
  LidarScan scan{PacketFormat(info)};
  scan.frame_id = static_cast<std::uint16_t>(k);
  const Eigen::Vector3d position(kSpeedMPerScan * k, 0.0, 0.0);
  for (int m = 0; m < info.columns_per_frame; ++m) {
    scan.column_time[static_cast<std::size_t>(m)] = nominal_time(info, k, m);
    scan.column_status[static_cast<std::size_t>(m)] = 1;
    for (int r = 0; r < info.pixels_per_column; ++r) {
      const Eigen::Vector3d start = position + lut.offset(r, m);
      const Eigen::Vector3d direction = lut.direction(r, m).normalized();
      const double range_m = wall_distance_m(start, direction);
      scan.range_mm(r, m) = static_cast<std::uint32_t>(std::lround(range_m * 1000.0));
      scan.signal(r, m) = brightness(start + range_m * direction);
      scan.near_ir(r, m) = 100;
    }
  }
  return scan;
}

}  // namespace

SensorInfo room_sensor() { return make_sensor(LidarProfile::kRng19Rfl8Sig16Nir16, 64, 512); }

LidarScan room_scan(const SensorInfo& info, int k) { return scan_of_room(info, XyzLut(info), k); }

std::vector<Bytes> room_packets(const SensorInfo& info, int count) {
  const XyzLut lut(info);
  std::vector<Bytes> packets;
  for (int k = 0; k < count; ++k) {
    for (Bytes& packet : encode(info, scan_of_room(info, lut, k)))
      packets.push_back(std::move(packet));
  }
  return packets;
}

}  // namespace glint::test
