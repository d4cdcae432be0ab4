// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/same_view.hpp"

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
constexpr double kLeastSameShare = 0.9;

struct Ranges {
  float least_m = std::numeric_limits<float>::infinity();
  float most_m = 0.0F;
};

struct Direction {
  int row = 0;
  int column = 0;
};

Direction direction_of(const Eigen::Vector3f& point_m, float range_m) {
  const double azimuth = std::atan2(point_m.y(), point_m.x()) + M_PI;
  const double elevation = std::asin(std::clamp(point_m.z() / range_m, -1.0F, 1.0F)) + M_PI_2;
  return {std::min(static_cast<int>(elevation * kCellsPerRad), kElevations - 1),
          std::min(static_cast<int>(azimuth * kCellsPerRad), kAzimuths - 1)};
}

Eigen::Vector3f position(const MapPoint& p) { return {p.x_m, p.y_m, p.z_m}; }
const Eigen::Vector3f& position(const Eigen::Vector3f& point_m) { return point_m; }

/// How near and how far a keyframe saw something, by direction.
class RangeView {
 public:
  template <class Point>
  explicit RangeView(std::span<const Point> points) {
    for (const Point& p : points) {
      const Eigen::Vector3f point_m = position(p);
      const float range_m = point_m.norm();
      if (range_m > 0.0F) widen(direction_of(point_m, range_m), range_m);
    }
  }

  [[nodiscard]] bool shows(const Eigen::Vector3f& point_m, float range_m) const {
    const Direction to = direction_of(point_m, range_m);
    const Ranges& seen = cells_[index_of(to.row, to.column)];
    const float slack_m = kSlack_m + kSlackShare * range_m;
    return range_m > seen.least_m - slack_m && range_m < seen.most_m + slack_m;
  }

 private:
  static std::size_t index_of(int row, int column) {
    const int index = row * kAzimuths + (column + kAzimuths) % kAzimuths;
    return static_cast<std::size_t>(index);
  }
  // From half a metre beside, and between two beams, a surface is seen in the next cell.
  void widen(const Direction& at, float range_m) {
    for (int row = std::max(at.row - 1, 0); row <= std::min(at.row + 1, kElevations - 1); ++row) {
      for (int column = at.column - 1; column <= at.column + 1; ++column) {
        Ranges& cell = cells_[index_of(row, column)];
        cell.least_m = std::min(cell.least_m, range_m);
        cell.most_m = std::max(cell.most_m, range_m);
      }
    }
  }

  std::array<Ranges, static_cast<std::size_t>(kAzimuths) * kElevations> cells_{};
};

template <class Point>
bool is_shown(std::span<const Point> kept, std::span<const Point> other, const Pose& T_kept_other) {
  const RangeView view(kept);
  const Eigen::Matrix3f rotation = T_kept_other.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation_m = T_kept_other.translation_m.cast<float>();
  std::size_t asked = 0;
  std::size_t found = 0;
  for (const Point& p : other) {
    const Eigen::Vector3f point_m = rotation * position(p) + translation_m;
    const float range_m = point_m.norm();
    if (range_m <= 0.0F) continue;
    ++asked;
    found += view.shows(point_m, range_m) ? 1 : 0;
  }
  return static_cast<double>(found) >= kLeastSameShare * static_cast<double>(asked);
}

}  // namespace

bool shows_the_same(std::span<const MapPoint> kept, std::span<const MapPoint> other,
                    const Pose& T_kept_other) {
  return is_shown(kept, other, T_kept_other);
}

bool shows_the_same(std::span<const Eigen::Vector3f> kept, std::span<const Eigen::Vector3f> other,
                    const Pose& T_kept_other) {
  return is_shown(kept, other, T_kept_other);
}

}  // namespace glint::slam
