// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map.hpp"

#include <cmath>

namespace glint::slam {
namespace {

// A voxel's number inside its tile. A tile has at most 16 m / 1 cm voxels along an axis.
constexpr std::uint64_t kVoxelsPerAxis = 2048;

std::int32_t cell(double coordinate_m, double edge_m) {
  return static_cast<std::int32_t>(std::floor(coordinate_m / edge_m));
}

}  // namespace

VoxelMap::VoxelMap(double voxel_m, std::size_t max_points)
    : voxel_m_(voxel_m), max_points_(max_points) {}

void VoxelMap::insert(const Pose& T_map_sensor, std::span<const MapPoint> points) {
  ++revision_;
  // Farther away a float no longer resolves a voxel, and a tile index could overflow.
  constexpr double kFarthest_m = 1e6;
  for (const MapPoint& point : points) {
    const Eigen::Vector3d p = T_map_sensor * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
    if (!(p.cwiseAbs().maxCoeff() < kFarthest_m)) continue;
    const TileIndex index = {cell(p.x(), kMapTile_m), cell(p.y(), kMapTile_m),
                             cell(p.z(), kMapTile_m)};
    std::uint64_t voxel = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double local_m = p[static_cast<Eigen::Index>(axis)] - index[axis] * kMapTile_m;
      voxel = voxel * kVoxelsPerAxis + static_cast<std::uint64_t>(local_m / voxel_m_);
    }
    WorkingTile& tile = tiles_[index];
    tile.tile.index = index;
    if (tile.occupied_voxels.contains(voxel)) continue;
    if (point_count_ >= max_points_) {
      ++points_refused_;
      continue;
    }
    tile.occupied_voxels.insert(voxel);
    tile.tile.points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                                static_cast<float>(p.z()), point.intensity});
    tile.tile.revision = revision_;
    tile.published.reset();
    ++point_count_;
  }
}

void VoxelMap::clear() {
  tiles_.clear();
  point_count_ = 0;
  ++revision_;
}

std::shared_ptr<MapSnapshot> VoxelMap::snapshot() {
  auto snapshot = std::make_shared<MapSnapshot>();
  snapshot->revision = revision_;
  snapshot->point_count = point_count_;
  snapshot->points_refused = points_refused_;
  for (auto& [index, tile] : tiles_) {
    if (tile.tile.points.empty()) continue;
    if (!tile.published) tile.published = std::make_shared<const MapTile>(tile.tile);
    snapshot->tiles.push_back(tile.published);
  }
  return snapshot;
}

}  // namespace glint::slam
