// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::slam {
namespace {

// A voxel's number inside its tile. A tile has at most 16 m / 1 cm voxels along an axis.
constexpr std::uint64_t kVoxelsPerAxis = 2048;

// About what a hash set takes for an entry, and a tile beside its points.
constexpr std::size_t kEntryBytes = 40;
constexpr std::size_t kBareTileBytes = 300;

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
  const TileIndex tile = {index_of(p.x(), kMapTile_m), index_of(p.y(), kMapTile_m),
                          index_of(p.z(), kMapTile_m)};
  return {tile, voxel_of(tile, p)};
}

// A point that a float has rounded onto the next tile still belongs to its own.
std::uint64_t VoxelMap::voxel_of(const TileIndex& tile, const Eigen::Vector3d& p) const {
  std::uint64_t voxel = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double local_m = p[static_cast<Eigen::Index>(axis)] - tile[axis] * kMapTile_m;
    voxel = voxel * kVoxelsPerAxis + static_cast<std::uint64_t>(std::max(0.0, local_m) / voxel_m_);
  }
  return voxel;
}

std::size_t VoxelMap::WorkingTile::bytes() const {
  std::size_t bytes = kBareTileBytes + points.capacity() * sizeof(MapPoint) +
                      views.capacity() * sizeof(std::uint32_t) +
                      occupied_voxels.size() * kEntryBytes;
  if (published && !published->points.is_cold()) {
    bytes += published->points.size() * sizeof(MapPoint);
  }
  return bytes;
}

void VoxelMap::WorkingTile::warm() {
  if (cold_points.empty()) return;
  points.assign(cold_points.begin(), cold_points.end());
  views.assign(cold_views.begin(), cold_views.end());
  cold_points = {};
  cold_views = {};
}

// Who asks for the tile from now on reads the file.
bool VoxelMap::WorkingTile::set_aside(const TileIndex& index, ColdFile& file) {
  const auto bytes = file.put(std::as_bytes(std::span(points)), std::as_bytes(std::span(views)));
  if (!bytes) return false;
  cold_points = {bytes, points.size()};
  cold_views = {{bytes, bytes.get() + points.size() * sizeof(MapPoint)}, views.size()};
  published = std::make_shared<const MapTile>(MapTile{index, revision, cold_points});
  // Their memory goes with them, which an empty list would keep.
  points = std::vector<MapPoint>();
  views = std::vector<std::uint32_t>();
  occupied_voxels = std::unordered_set<std::uint64_t>();
  indexed = false;
  return true;
}

std::size_t VoxelMap::bytes() const {
  std::size_t bytes = 0;
  for (const auto& [index, tile] : tiles_) bytes += tile.bytes();
  return bytes;
}

void VoxelMap::keep_within(std::shared_ptr<ColdFile> file, std::size_t most_bytes) {
  file_ = std::move(file);
  most_bytes_ = most_bytes;
  set_tiles_aside();
}

void VoxelMap::set_tiles_aside() {
  std::size_t now = bytes();
  if (!file_ || now <= most_bytes_) return;
  std::vector<std::pair<const TileIndex, WorkingTile>*> tiles;
  for (auto& entry : tiles_) {
    if (!entry.second.points.empty()) tiles.push_back(&entry);
  }
  std::ranges::stable_sort(tiles, {}, [](const auto* entry) { return entry->second.last_view; });
  for (auto* const entry : tiles) {
    if (now <= most_bytes_) return;
    now -= entry->second.bytes();
    if (!entry->second.set_aside(entry->first, *file_)) return;
    now += entry->second.bytes();
  }
}

// In memory, with the voxels that hold a point.
VoxelMap::WorkingTile& VoxelMap::tile_to_fill(const TileIndex& index) {
  WorkingTile& tile = tiles_[index];
  tile.last_view = view_count_;
  if (tile.indexed) return tile;
  tile.warm();
  tile.occupied_voxels.reserve(tile.points.size());
  for (const MapPoint& point : tile.points) {
    tile.occupied_voxels.insert(voxel_of(index, {point.x_m, point.y_m, point.z_m}));
  }
  tile.indexed = true;
  return tile;
}

void VoxelMap::put(WorkingTile& tile, const MapPoint& point, std::uint32_t view) {
  tile.revision = revision_;
  tile.points.push_back(point);
  tile.views.push_back(view);
  tile.published.reset();
  ++point_count_;
}

void VoxelMap::insert(const Pose& T_map_sensor, std::span<const MapPoint> points) {
  ++revision_;
  for (const MapPoint& point : points) {
    const Eigen::Vector3d p = T_map_sensor * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
    if (!possible(p)) continue;
    const Cell cell = cell_of(p);
    const bool full = point_count_ >= max_points_;
    if (full && !tiles_.contains(cell.tile)) {
      ++points_refused_;
      continue;
    }
    WorkingTile& tile = tile_to_fill(cell.tile);
    if (tile.occupied_voxels.contains(cell.voxel)) continue;
    if (full) {
      ++points_refused_;
      continue;
    }
    tile.occupied_voxels.insert(cell.voxel);
    put(tile, map_point(p, point.intensity), view_count_);
    removed_.erase(cell.tile);
  }
  ++view_count_;
}

void VoxelMap::skip_view(std::size_t points) {
  points_refused_ += points;
  ++view_count_;
}

// Which voxels hold a point is found out when a tile is next seen.
void VoxelMap::move_tile(WorkingTile& old, std::span<const Pose> T_new_old) {
  old.warm();
  for (std::size_t i = 0; i < old.views.size(); ++i) {
    const MapPoint& point = old.points[i];
    const Eigen::Vector3d p =
        T_new_old[old.views[i]] * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
    if (!possible(p)) continue;
    WorkingTile& tile = tiles_[cell_of(p).tile];
    tile.warm();
    tile.last_view = std::max(tile.last_view, old.last_view);
    put(tile, map_point(p, point.intensity), old.views[i]);
  }
}

void VoxelMap::move(std::span<const Pose> T_new_old) {
  // Tiles that are moved between two looks at how much memory they take.
  constexpr std::size_t kBetween = 16;
  moved_revision_ = ++revision_;
  point_count_ = 0;
  std::map<TileIndex, WorkingTile> old = std::exchange(tiles_, {});
  // Most points stay in their tile: room for them is made at once.
  for (const auto& [index, tile] : old) {
    if (tile.points.empty()) continue;
    WorkingTile& fresh = tiles_[index];
    fresh.points.reserve(tile.points.size());
    fresh.views.reserve(tile.views.size());
  }
  std::vector<TileIndex> before;
  before.reserve(old.size());
  while (!old.empty()) {
    before.push_back(old.begin()->first);
    move_tile(old.begin()->second, T_new_old);
    old.erase(old.begin());
    if (before.size() % kBetween == 0) set_tiles_aside();
  }
  set_tiles_aside();
  std::erase_if(tiles_, [](const auto& entry) { return entry.second.count() == 0; });
  for (const auto& [index, tile] : tiles_) removed_.erase(index);
  for (const TileIndex& index : before) {
    if (!tiles_.contains(index)) removed_[index] = revision_;
  }
}

std::shared_ptr<MapSnapshot> VoxelMap::snapshot() {
  auto snapshot = std::make_shared<MapSnapshot>();
  snapshot->revision = revision_;
  snapshot->point_count = point_count_;
  snapshot->points_refused = points_refused_;
  snapshot->moved_revision = moved_revision_;
  for (const auto& [index, revision] : removed_) snapshot->removed.push_back({index, revision});
  for (auto& [index, tile] : tiles_) {
    if (tile.count() == 0) continue;
    if (!tile.published) {
      tile.published = std::make_shared<const MapTile>(MapTile{index, tile.revision, tile.points});
    }
    snapshot->tiles.push_back(tile.published);
  }
  return snapshot;
}

}  // namespace glint::slam
