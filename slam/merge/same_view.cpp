// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/merge/same_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace glint::slam {
namespace {

// Cells of 5 degrees: a few points of the sparsest sensor in each.
constexpr int kAzimuths = 72;
constexpr int kElevations = 36;
constexpr double kCellsPerRad = kAzimuths / (2.0 * M_PI);
// What half a metre of way moves a surface by, seen in one cell.
constexpr float kSlack_m = 0.5F;
constexpr float kSlackShare = 0.05F;
constexpr double kLeastShare = 0.9;

struct Ranges {
  float least_m = std::numeric_limits<float>::infinity();
  float most_m = 0.0F;
};

std::size_t direction_of(const Eigen::Vector3f& point_m, float range_m) {
  const double azimuth = std::atan2(point_m.y(), point_m.x()) + M_PI;
  const double elevation = std::asin(std::clamp(point_m.z() / range_m, -1.0F, 1.0F)) + M_PI_2;
  const int column = std::min(static_cast<int>(azimuth * kCellsPerRad), kAzimuths - 1);
  const int row = std::min(static_cast<int>(elevation * kCellsPerRad), kElevations - 1);
  return static_cast<std::size_t>(row * kAzimuths + column);
}

}  // namespace

bool shows_the_same(std::span<const MapPoint> kept, std::span<const MapPoint> other,
                    const Pose& T_kept_other) {
  std::array<Ranges, static_cast<std::size_t>(kAzimuths) * kElevations> seen{};
  for (const MapPoint& p : kept) {
    const Eigen::Vector3f point_m(p.x_m, p.y_m, p.z_m);
    const float range_m = point_m.norm();
    if (range_m <= 0.0F) continue;
    Ranges& cell = seen[direction_of(point_m, range_m)];
    cell.least_m = std::min(cell.least_m, range_m);
    cell.most_m = std::max(cell.most_m, range_m);
  }
  const Eigen::Matrix3f rotation = T_kept_other.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation_m = T_kept_other.translation_m.cast<float>();
  std::size_t asked = 0;
  std::size_t found = 0;
  for (const MapPoint& p : other) {
    const Eigen::Vector3f point_m = rotation * Eigen::Vector3f(p.x_m, p.y_m, p.z_m) + translation_m;
    const float range_m = point_m.norm();
    if (range_m <= 0.0F) continue;
    const Ranges& cell = seen[direction_of(point_m, range_m)];
    const float slack_m = kSlack_m + kSlackShare * range_m;
    ++asked;
    found += range_m > cell.least_m - slack_m && range_m < cell.most_m + slack_m ? 1 : 0;
  }
  return static_cast<double>(found) >= kLeastShare * static_cast<double>(asked);
}

}  // namespace glint::slam
