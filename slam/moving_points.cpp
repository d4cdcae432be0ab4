// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/moving_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace glint::slam {
namespace {

// Cells of two degrees; next to one another, beams of any sensor hit each.
constexpr int kViewColumns = 180;
constexpr int kViewRows = 90;
constexpr float kUnseen = std::numeric_limits<float>::infinity();
// Keyframes whose views are kept: some seconds of a walk.
constexpr std::size_t kViews = 4;
// Farther than the point by so much, and by this share of its range.
constexpr float kThroughMargin_m = 0.5F;
constexpr float kThroughShare = 0.05F;

struct Cell {
  int row;
  int column;
};

Cell cell_of(const Eigen::Vector3f& point_m) {
  const float azimuth = std::atan2(point_m.y(), point_m.x()) / std::numbers::pi_v<float>;
  const float altitude =
      std::atan2(point_m.z(), point_m.head<2>().norm()) / std::numbers::pi_v<float>;
  return {
      std::clamp(static_cast<int>((altitude + 0.5F) * kViewRows), 0, kViewRows - 1),
      std::clamp(static_cast<int>((azimuth + 1.0F) * 0.5F * kViewColumns), 0, kViewColumns - 1)};
}

std::size_t index_of(int row, int column) {
  const int index = row * kViewColumns + (column + kViewColumns) % kViewColumns;
  return static_cast<std::size_t>(index);
}

}  // namespace

const std::vector<MapPoint>& MovingPoints::standing(const Keyframe& keyframe) {
  standing_.clear();
  const Pose& T_odom_sensor = keyframe.estimate.T_odom_sensor;
  std::vector<std::pair<const View*, Pose>> before;
  for (const View& view : views_) {
    if (view.segment != keyframe.estimate.segment) continue;
    before.emplace_back(&view, view.T_odom_sensor.inverse() * T_odom_sensor);
  }
  for (const MapPoint& point : keyframe.points) {
    const Eigen::Vector3d point_m(point.x_m, point.y_m, point.z_m);
    const bool came = std::ranges::any_of(before, [&](const auto& then) {
      return saw_through(*then.first, (then.second * point_m).template cast<float>());
    });
    if (!came) standing_.push_back(point);
  }
  left_out_ += keyframe.points.size() - standing_.size();
  remember(keyframe);
  return standing_;
}

bool MovingPoints::saw_through(const View& view, const Eigen::Vector3f& point_m) {
  const Cell cell = cell_of(point_m);
  if (view.range_m[index_of(cell.row, cell.column)] == kUnseen) return false;
  const float limit_m = point_m.norm() * (1.0F + kThroughShare) + kThroughMargin_m;
  for (int row = std::max(cell.row - 1, 0); row <= std::min(cell.row + 1, kViewRows - 1); ++row) {
    for (int column = cell.column - 1; column <= cell.column + 1; ++column) {
      if (view.range_m[index_of(row, column)] < limit_m) return false;
    }
  }
  return true;
}

void MovingPoints::remember(const Keyframe& keyframe) {
  View view;
  if (views_.size() >= kViews) {
    view = std::move(views_.front());
    views_.pop_front();
  }
  view.segment = keyframe.estimate.segment;
  view.T_odom_sensor = keyframe.estimate.T_odom_sensor;
  view.range_m.assign(static_cast<std::size_t>(kViewRows) * kViewColumns, kUnseen);
  for (const MapPoint& point : keyframe.points) {
    const Eigen::Vector3f point_m(point.x_m, point.y_m, point.z_m);
    const Cell cell = cell_of(point_m);
    float& range_m = view.range_m[index_of(cell.row, cell.column)];
    range_m = std::min(range_m, point_m.norm());
  }
  views_.push_back(std::move(view));
}

}  // namespace glint::slam
