// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/test_painted_tunnel.hpp"

#include <Eigen/Core>
#include <cmath>

namespace glint::test {
namespace {

constexpr double kRadius_m = 3.0;

}  // namespace

double rings(double x_m, double /*angle_rad*/) {
  const double off_m = std::remainder(x_m, 3.0);
  return 128.0 - 90.0 * std::exp(-off_m * off_m / (2.0 * 0.06 * 0.06));
}

void see_tunnel(const SensorInfo& info, const XyzLut& lut, const Pose& T_tunnel_sensor,
                const Paint& paint, slam::ScanImages& images) {
  images.range_mm = {info.pixels_per_column, info.columns_per_frame};
  images.brightness = {info.pixels_per_column, info.columns_per_frame};
  for (int row = 0; row < info.pixels_per_column; ++row) {
    const int shift = info.pixel_shift_by_row[static_cast<std::size_t>(row)];
    for (int m = 0; m < info.columns_per_frame; ++m) {
      const int u = (m + shift) % info.columns_per_frame;
      const Eigen::Vector3d ray = T_tunnel_sensor.rotation * lut.direction(row, m) * 1000.0;
      const Eigen::Vector2d at_m = T_tunnel_sensor.translation_m.tail<2>();
      const Eigen::Vector2d across = ray.tail<2>();
      const double a = across.squaredNorm();
      const double b = at_m.dot(across);
      const double range_m =
          (-b + std::sqrt(b * b + a * (kRadius_m * kRadius_m - at_m.squaredNorm()))) / a;
      const Eigen::Vector3d wall_m = T_tunnel_sensor.translation_m + range_m * ray;
      const bool seen = range_m < 60.0;
      images.range_mm(row, u) =
          seen ? static_cast<std::uint32_t>(std::lround(1000.0 * range_m)) : 0U;
      images.brightness(row, u) = static_cast<std::uint8_t>(
          seen ? std::lround(paint(wall_m.x(), std::atan2(wall_m.z(), wall_m.y()))) : 128);
    }
  }
}

}  // namespace glint::test
