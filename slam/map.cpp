// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map.hpp"

#include <cmath>
#include <utility>

namespace glint::slam {
namespace {

// A voxel's number inside its tile. A tile has at most 16 m / 1 cm voxels along an axis.
constexpr std::uint64_t kVoxelsPerAxis = 2048;

std::int32_t index_of(double coordinate_m, double edge_m) {
  return static_cast<std::int32_t>(std::floor(coordinate_m / edge_m));
}

// Farther away a float no longer resolves a voxel, and a tile index could overflow.
bool possible(const Eigen::Vector3d& p) {
  constexpr double kFarthest_m = 1e6;
  return p.cwiseAbs().maxCoeff() < kFarthest_m;
}

MapPoint map_point(const Eigen::Vector3d& p, float intensity) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()),
          intensity};
}

}  // namespace

VoxelMap::VoxelMap(double voxel_m, std::size_t max_points)
    : voxel_m_(voxel_m), max_points_(max_points) {}

VoxelMap::Cell VoxelMap::cell_of(const Eigen::Vector3d& p) const {
  Cell out{{index_of(p.x(), kMapTile_m), index_of(p.y(), kMapTile_m), index_of(p.z(), kMapTile_m)},
           0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double local_m = p[static_cast<Eigen::Index>(axis)] - out.tile[axis] * kMapTile_m;
    out.voxel = out.voxel * kVoxelsPerAxis + static_cast<std::uint64_t>(local_m / voxel_m_);
  }
  return out;
}

void VoxelMap::put(const Cell& cell, const MapPoint& point, std::uint32_t view) {
  WorkingTile& tile = tiles_[cell.tile];
  tile.tile.index = cell.tile;
  tile.tile.revision = revision_;
  tile.tile.points.push_back(point);
  tile.views.push_back(view);
  tile.occupied_voxels.insert(cell.voxel);
  tile.published.reset();
  ++point_count_;
}

void VoxelMap::insert(const Pose& T_map_sensor, std::span<const MapPoint> points) {
  ++revision_;
  for (const MapPoint& point : points) {
    const Eigen::Vector3d p = T_map_sensor * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
    if (!possible(p)) continue;
    const Cell cell = cell_of(p);
    const auto tile = tiles_.find(cell.tile);
    if (tile != tiles_.end() && tile->second.occupied_voxels.contains(cell.voxel)) continue;
    if (point_count_ >= max_points_) {
      ++points_refused_;
      continue;
    }
    put(cell, map_point(p, point.intensity), view_count_);
    removed_.erase(cell.tile);
  }
  ++view_count_;
}

void VoxelMap::move(std::span<const Pose> T_new_old) {
  moved_revision_ = ++revision_;
  point_count_ = 0;
  const std::map<TileIndex, WorkingTile> old = std::exchange(tiles_, {});
  // Most points stay in their tile: room for them is made at once.
  for (const auto& [index, tile] : old) {
    WorkingTile& fresh = tiles_[index];
    fresh.tile.points.reserve(tile.views.size());
    fresh.views.reserve(tile.views.size());
    fresh.occupied_voxels.reserve(tile.occupied_voxels.size());
  }
  for (const auto& [index, tile] : old) {
    for (std::size_t i = 0; i < tile.views.size(); ++i) {
      const MapPoint& point = tile.tile.points[i];
      const Eigen::Vector3d p =
          T_new_old[tile.views[i]] * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
      if (possible(p)) put(cell_of(p), map_point(p, point.intensity), tile.views[i]);
    }
  }
  for (const auto& [index, tile] : tiles_) removed_.erase(index);
  std::erase_if(tiles_, [&](const auto& entry) {
    const bool empty = entry.second.views.empty();
    if (empty) removed_[entry.first] = revision_;
    return empty;
  });
}

std::shared_ptr<MapSnapshot> VoxelMap::snapshot() {
  auto snapshot = std::make_shared<MapSnapshot>();
  snapshot->revision = revision_;
  snapshot->point_count = point_count_;
  snapshot->points_refused = points_refused_;
  snapshot->moved_revision = moved_revision_;
  for (const auto& [index, revision] : removed_) snapshot->removed.push_back({index, revision});
  for (auto& [index, tile] : tiles_) {
    if (tile.tile.points.empty()) continue;
    if (!tile.published) tile.published = std::make_shared<const MapTile>(tile.tile);
    snapshot->tiles.push_back(tile.published);
  }
  return snapshot;
}

}  // namespace glint::slam
