// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/floor_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace glint::slam {
namespace {

// As many directions as leave no gap between two rays in cells of 5 cm up to 11 m.
constexpr int kRays = 1440;
// Where the floor is looked for: not the carrier, and not so far that it has left a layer's height.
constexpr double kFloorFrom_m = 1.0;
constexpr double kFloorTo_m = 15.0;
// It lies at least this far below the sensor, and at most that far.
constexpr double kLeastBelow_m = 0.15;
constexpr double kMostBelow_m = 5.0;
constexpr double kLayer_m = 0.05;
// Something is there if it was seen at least once for so many times that it was seen through: thin
// and dark things are missed, and what moved is seen through more often.
constexpr int kPassesAHit = 3;

int index_at(double coordinate_m, double cell_m) {
  return static_cast<int>(std::floor(coordinate_m / cell_m));
}

// Of what is not negative.
std::size_t unsigned_of(int value) { return static_cast<std::size_t>(value); }

int floor_divided(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

Eigen::Vector3f vector_of(const MapPoint& point) { return {point.x_m, point.y_m, point.z_m}; }

// How far below the sensor the layer is that holds most of what is seen below it: walls spread over
// all heights, a floor does not. Null where nothing is below.
std::optional<double> height_above_floor_m(const Eigen::Vector3d& up,
                                           const std::vector<MapPoint>& points) {
  std::array<int, static_cast<std::size_t>(kMostBelow_m / kLayer_m)> layers{};
  for (const MapPoint& point : points) {
    const Eigen::Vector3d p = vector_of(point).cast<double>();
    const double below_m = -up.dot(p);
    const double away_m = (p + below_m * up).norm();
    if (away_m < kFloorFrom_m || !(away_m < kFloorTo_m)) continue;
    if (below_m < kLeastBelow_m || below_m >= kMostBelow_m) continue;
    ++layers[static_cast<std::size_t>(below_m / kLayer_m) % layers.size()];
  }
  const auto fullest = std::ranges::max_element(layers);
  if (*fullest == 0) return std::nullopt;
  return (static_cast<double>(fullest - layers.begin()) + 0.5) * kLayer_m;
}

}  // namespace

FloorPlan::FloorPlan(const FloorPlanOptions& options) : options_(options) {}

// The floor as this view sees it, sloping or not; else level and as far below as it was last.
GroundPlane FloorPlan::floor_of(const Eigen::Vector3d& up, const std::vector<MapPoint>& points) {
  if (const auto height_m = height_above_floor_m(up, points)) height_m_ = *height_m;
  std::vector<Eigen::Vector3f> points_m;
  points_m.reserve(points.size());
  for (const MapPoint& point : points) points_m.push_back(vector_of(point));
  GroundOptions near_layer;
  near_layer.sensor_height_m = height_m_;
  near_layer.height_band_m = 2.0 * kLayer_m;
  std::size_t on_floor = 0;
  const auto found = GroundFinder(near_layer).find(points_m, up, &on_floor);
  return found ? *found : GroundPlane{up, height_m_, 0};
}

FloorPlan::Sight FloorPlan::look(const Pose& T_map_sensor, const std::vector<MapPoint>& points) {
  const Eigen::Matrix3d R_map_sensor = T_map_sensor.rotation.toRotationMatrix();
  const GroundPlane floor = floor_of(R_map_sensor.transpose().col(2), points);
  Sight sight;
  sight.rays.resize(kRays);
  for (const MapPoint& point : points) {
    const Eigen::Vector3d p = vector_of(point).cast<double>();
    const Eigen::Vector2d level_m = (R_map_sensor * p).head<2>();
    const double range_m = level_m.norm();
    const double height_m = floor.normal.dot(p) + floor.height_m;
    // So written, it also leaves out what is no number.
    if (!(range_m <= options_.farthest_m && height_m <= options_.highest_m)) continue;
    const double turn = std::atan2(level_m.y(), level_m.x()) / (2.0 * std::numbers::pi) + 0.5;
    Ray& ray = sight.rays[static_cast<std::size_t>(turn * kRays) % kRays];
    if (height_m < options_.lowest_m) {
      // A hole in the floor is no place to go to, but nothing stands there either.
      ray.farthest_floor_m = std::max(ray.farthest_floor_m, range_m);
      continue;
    }
    const double nearest_m = ray.nearest_obstacle_m;
    ray.nearest_obstacle_m = nearest_m > 0.0 ? std::min(nearest_m, range_m) : range_m;
    sight.obstacles_m.push_back(T_map_sensor.translation_m.head<2>() + level_m);
  }
  return sight;
}

void FloorPlan::add(const Pose& T_map_sensor, const std::vector<MapPoint>& points) {
  ++view_;
  const Sight sight = look(T_map_sensor, points);
  // First, so that no ray of this view passes through what it has hit.
  for (const Eigen::Vector2d& obstacle_m : sight.obstacles_m) hit(obstacle_m);
  for (int i = 0; i < kRays; ++i) {
    const Ray& ray = sight.rays[static_cast<std::size_t>(i)];
    const double azimuth_rad = ((i + 0.5) / kRays - 0.5) * 2.0 * std::numbers::pi;
    const double length_m =
        ray.nearest_obstacle_m > 0.0 ? ray.nearest_obstacle_m : ray.farthest_floor_m;
    pass(T_map_sensor.translation_m.head<2>(), azimuth_rad, length_m);
  }
}

FloorPlan::Cell& FloorPlan::cell(int column, int row) {
  const std::pair index{floor_divided(column, kTileCells), floor_divided(row, kTileCells)};
  if (last_tile_ == nullptr || index != last_index_) {
    last_tile_ = &tiles_[index];
    last_index_ = index;
    last_tile_->resize(static_cast<std::size_t>(kTileCells) * kTileCells);
  }
  const int x = column - index.first * kTileCells;
  const int y = row - index.second * kTileCells;
  return (*last_tile_)[unsigned_of(y) * kTileCells + unsigned_of(x)];
}

// Each view counts once for a cell.
void FloorPlan::hit(const Eigen::Vector2d& point_m) {
  Cell& c = cell(index_at(point_m.x(), options_.cell_m), index_at(point_m.y(), options_.cell_m));
  if (std::exchange(c.last_view, view_) == view_) return;
  if (c.hits < std::numeric_limits<std::uint16_t>::max()) ++c.hits;
}

void FloorPlan::pass(const Eigen::Vector2d& from_m, double azimuth_rad, double length_m) {
  const Eigen::Vector2d direction(std::cos(azimuth_rad), std::sin(azimuth_rad));
  for (double along_m = 0.0; along_m < length_m; along_m += options_.cell_m) {
    const Eigen::Vector2d p = from_m + along_m * direction;
    Cell& c = cell(index_at(p.x(), options_.cell_m), index_at(p.y(), options_.cell_m));
    if (std::exchange(c.last_view, view_) == view_) continue;
    if (c.passes < std::numeric_limits<std::uint16_t>::max()) ++c.passes;
  }
}

FloorCell FloorPlan::state_of(const Cell& cell) {
  if (cell.hits == 0 && cell.passes == 0) return FloorCell::kUnknown;
  const bool stands = cell.hits > 0 && kPassesAHit * cell.hits >= cell.passes;
  return stands ? FloorCell::kOccupied : FloorCell::kFree;
}

FloorPlanImage FloorPlan::image() const {
  FloorPlanImage out;
  out.cell_m = options_.cell_m;
  if (tiles_.empty()) return out;
  const int first_column = tiles_.begin()->first.first;
  const int last_column = tiles_.rbegin()->first.first;
  const auto by_row = [](const auto& a, const auto& b) { return a.first.second < b.first.second; };
  const auto [lowest, highest] = std::ranges::minmax_element(tiles_, by_row);
  const int first_row = lowest->first.second;
  out.width = (last_column - first_column + 1) * kTileCells;
  out.height = (highest->first.second - first_row + 1) * kTileCells;
  out.origin_m = Eigen::Vector2d(first_column, first_row) * kTileCells * options_.cell_m;
  const auto width = static_cast<std::size_t>(out.width);
  out.cells.resize(width * static_cast<std::size_t>(out.height));
  for (const auto& [index, tile] : tiles_) {
    const auto left = unsigned_of(index.first - first_column) * kTileCells;
    const auto bottom = unsigned_of(index.second - first_row) * kTileCells;
    for (std::size_t i = 0; i < tile.size(); ++i) {
      out.cells[(bottom + i / kTileCells) * width + left + i % kTileCells] = state_of(tile[i]);
    }
  }
  return out;
}

}  // namespace glint::slam
