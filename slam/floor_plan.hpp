// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "slam/ground.hpp"
#include "slam/keyframe.hpp"

namespace glint::slam {

struct FloorPlanOptions {
  double cell_m = 0.05;
  /// What stands this high above the floor is in a robot's way, m.
  double lowest_m = 0.15;
  double highest_m = 2.0;
  double farthest_m = 30.0;  ///< Returns beyond are not looked at.
};

enum class FloorCell : std::uint8_t { kUnknown, kFree, kOccupied };

/// A map seen from above, to plan ways in. Row 0 is that of the least y, column 0 of the least x.
struct FloorPlanImage {
  int width = 0;
  int height = 0;
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();  ///< Lower left corner, map frame.
  double cell_m = 0.0;
  std::vector<FloorCell> cells;  ///< Row by row.
};

/// Draws a plan of one storey as a level 2-D scanner would see it: in each direction all is free up
/// to the first thing that stands in the way, or to the last of the floor that is seen. What later
/// views see through is free again. Deterministic. Thread-compatible.
class FloorPlan {
 public:
  explicit FloorPlan(const FloorPlanOptions& options);

  /// A view: points in the sensor frame, m.
  void add(const Pose& T_map_sensor, const std::vector<MapPoint>& points);
  /// All that is known, in squares of 128 cells; no cells where nothing is.
  [[nodiscard]] FloorPlanImage image() const;

 private:
  struct Cell {
    std::uint16_t hits = 0;    ///< Views that saw something there.
    std::uint16_t passes = 0;  ///< Views that saw through.
    std::uint32_t last_view = 0;
  };
  static constexpr int kTileCells = 128;  ///< Edge of a tile.
  using Tile = std::vector<Cell>;
  /// What one direction shows, m from the sensor.
  struct Ray {
    double nearest_obstacle_m = 0.0;  ///< 0: none.
    double farthest_floor_m = 0.0;
  };

  /// What one view shows.
  struct Sight {
    std::vector<Ray> rays;                     ///< By azimuth.
    std::vector<Eigen::Vector2d> obstacles_m;  ///< Map frame.
  };

  [[nodiscard]] Sight look(const Pose& T_map_sensor, const std::vector<MapPoint>& points);
  [[nodiscard]] GroundPlane floor_of(const Eigen::Vector3d& up,
                                     const std::vector<MapPoint>& points);
  Cell& cell(int column, int row);
  void hit(const Eigen::Vector2d& point_m);
  void pass(const Eigen::Vector2d& from_m, double azimuth_rad, double length_m);
  [[nodiscard]] static FloorCell state_of(const Cell& cell);

  const FloorPlanOptions options_;
  double height_m_ = 1.0;  ///< Of the sensor above the floor, as last seen; a robot's, until it is.
  std::map<std::pair<int, int>, Tile> tiles_;  ///< By column and row of tiles.
  std::pair<int, int> last_index_{0, 0};
  Tile* last_tile_ = nullptr;
  std::uint32_t view_ = 0;
};

}  // namespace glint::slam
