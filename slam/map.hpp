// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <unordered_set>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/cold_array.hpp"
#include "slam/cold_file.hpp"
#include "slam/keyframe.hpp"

namespace glint::slam {

/// Integer coordinates of a map tile: floor(coordinate / kMapTile_m) per axis, map frame.
using TileIndex = std::array<std::int32_t, 3>;
/// Edge of a tile, m.
constexpr double kMapTile_m = 16.0;

/// A cube of the map. Immutable once published.
struct MapTile {
  TileIndex index{};
  std::uint64_t revision = 0;  ///< Map revision at which the tile last changed.
  ColdArray<MapPoint> points;  ///< Map frame, m; in order of arrival, one per voxel.
};

/// A tile that is no more, since this revision.
struct RemovedTile {
  TileIndex index{};
  std::uint64_t revision = 0;
};

/// The whole map at one revision; tiles are shared with later snapshots while they do not change.
struct MapSnapshot {
  std::uint64_t revision = 0;
  std::size_t point_count = 0;
  std::size_t keyframe_count = 0;
  std::uint64_t points_refused = 0;  ///< New voxels not stored because the map is full.
  std::vector<std::shared_ptr<const MapTile>> tiles;  ///< Ordered by index.
  std::uint64_t moved_revision = 0;                   ///< At which all points moved last.
  std::vector<RemovedTile> removed;                   ///< Ordered by index.
  std::uint32_t epoch = 0;                            ///< Of the correction it is made with.
};

/// Voxel-downsampled points in the map frame: the first point to fall into a voxel stays. When the
/// views that brought them are moved, points move with them and all stay, so that no correction
/// wears holes. Bounded by `max_points`, and in memory by keep_within(). Deterministic.
/// Thread-compatible; snapshots may be read anywhere.
class VoxelMap {
 public:
  /// `voxel_m`: edge of a voxel, at least 0.01 m.
  VoxelMap(double voxel_m, std::size_t max_points);

  /// Adds points given in the sensor frame, seen from T_map_sensor: the next view, from 0 on.
  void insert(const Pose& T_map_sensor, std::span<const MapPoint> points);
  /// Moves the points that each view brought: T_new_old of view 0, 1, ... in the map frame.
  void move(std::span<const Pose> T_new_old);
  [[nodiscard]] std::size_t point_count() const { return point_count_; }
  /// Memory taken by tiles, about, bytes.
  [[nodiscard]] std::size_t bytes() const;
  /// From now on, at most so much stays in memory so far as the file takes the rest: tiles go there
  /// that were longest unseen, now and while points move, and come back when they are seen again.
  /// What the map holds does not depend on it.
  void keep_within(std::shared_ptr<ColdFile> file, std::size_t most_bytes);
  /// Takes note of a view of which nothing is to be added.
  void skip_view(std::size_t points);
  /// The present state; copies only tiles that changed since the last call.
  [[nodiscard]] std::shared_ptr<MapSnapshot> snapshot();

 private:
  struct WorkingTile {
    std::uint64_t revision = 0;
    std::vector<MapPoint> points;
    std::vector<std::uint32_t> views;  ///< That brought each of its points.
    ColdArray<MapPoint> cold_points;   ///< In place of these while it is set aside.
    ColdArray<std::uint32_t> cold_views;
    std::shared_ptr<const MapTile> published;  ///< Null while there are changes to publish.
    std::unordered_set<std::uint64_t> occupied_voxels;  ///< Voxels that hold a point.
    bool indexed = false;                               ///< These are known.
    std::uint32_t last_view = 0;                        ///< That saw something in it.

    [[nodiscard]] std::size_t count() const { return points.size() + cold_points.size(); }
    [[nodiscard]] std::size_t bytes() const;
    void warm();
    [[nodiscard]] bool set_aside(const TileIndex& index, ColdFile& file);
  };

  struct Cell {
    TileIndex tile;
    std::uint64_t voxel;
  };
  [[nodiscard]] Cell cell_of(const Eigen::Vector3d& p) const;
  [[nodiscard]] std::uint64_t voxel_of(const TileIndex& tile, const Eigen::Vector3d& p) const;
  WorkingTile& tile_to_fill(const TileIndex& index);
  void put(WorkingTile& tile, const MapPoint& point, std::uint32_t view);
  void move_tile(WorkingTile& old, std::span<const Pose> T_new_old);
  void set_tiles_aside();

  const double voxel_m_;
  const std::size_t max_points_;
  std::uint32_t view_count_ = 0;
  std::map<TileIndex, WorkingTile> tiles_;
  std::map<TileIndex, std::uint64_t> removed_;  ///< Tiles that are no more, and since when.
  std::uint64_t revision_ = 0;
  std::uint64_t moved_revision_ = 0;
  std::size_t point_count_ = 0;
  std::uint64_t points_refused_ = 0;
  std::shared_ptr<ColdFile> file_;  ///< For tiles that are set aside; null while all may stay.
  std::size_t most_bytes_ = 0;
};

}  // namespace glint::slam
