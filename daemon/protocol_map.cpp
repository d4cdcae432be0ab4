// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/protocol_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unordered_set>

#include "daemon/base64.hpp"

namespace glint::daemon {
namespace {

/// Bytes of points a page: base64 makes 4 bytes of 3, and the rest of the line needs its room. a
/// float as a JSON number takes up to 24 bytes.
constexpr std::size_t kPageBytes = 900'000;
constexpr std::size_t kBase64PointBytes = 22;
constexpr std::size_t kJsonPointBytes = 104;
constexpr std::size_t kTileBytes = 120;
constexpr double kMaxCoordinateM = 1e6;
/// Voxels finer than this do not fit into a tile's key, and are finer than any map kept.
constexpr double kMinVoxelM = 0.01;

static_assert(sizeof(slam::MapPoint) == 16, "points go out as they lie in memory");

[[noreturn]] void refuse_cursor() {
  throw RpcError(kInvalidParams, "cursor must be the next_cursor of an earlier answer", "cursor");
}

MapCursor parse_cursor(const Json& value) {
  if (!value.is_string()) refuse_cursor();
  const auto& text = value.get_ref<const std::string&>();
  MapCursor cursor;
  int used = 0;
  const int fields =
      std::sscanf(text.c_str(), "%lu:%d:%d:%d:%zu%n", &cursor.revision, &cursor.tile[0],
                  &cursor.tile[1], &cursor.tile[2], &cursor.offset, &used);
  if (fields != 5 || static_cast<std::size_t>(used) != text.size()) refuse_cursor();
  return cursor;
}

std::string cursor_text(const MapCursor& c) {
  return fmt::format("{}:{}:{}:{}:{}", c.revision, c.tile[0], c.tile[1], c.tile[2], c.offset);
}

Eigen::Vector3d corner(const Json& region, const char* name) {
  const auto found = region.find(name);
  Eigen::Vector3d out;
  bool ok = found != region.end() && found->is_array() && found->size() == 3;
  for (std::size_t i = 0; ok && i < 3; ++i) {
    ok = (*found)[i].is_number() && std::abs((*found)[i].get<double>()) <= kMaxCoordinateM;
    if (ok) out[static_cast<Eigen::Index>(i)] = (*found)[i].get<double>();
  }
  if (!ok) {
    throw RpcError(kInvalidParams, "region must be {\"min_m\":[x,y,z],\"max_m\":[x,y,z]}",
                   "region");
  }
  return out;
}

bool overlaps(const slam::TileIndex& tile, const MapQuery& query) {
  if (!query.region) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const double low = tile[i] * slam::kMapTile_m;
    if (low > (*query.region)[1][axis] || low + slam::kMapTile_m < (*query.region)[0][axis])
      return false;
  }
  return true;
}

bool inside(const slam::MapPoint& p, const MapQuery& query) {
  if (!query.region) return true;
  const Eigen::Array3d x(p.x_m, p.y_m, p.z_m);
  return (x >= (*query.region)[0].array()).all() && (x <= (*query.region)[1].array()).all();
}

/// Tells of each point in turn whether it is the first one in its voxel.
class Thinner {
 public:
  explicit Thinner(double voxel_m) : voxel_m_(voxel_m) {}
  bool first(const slam::MapPoint& p) { return voxel_m_ <= 0.0 || seen_.insert(key(p)).second; }

 private:
  [[nodiscard]] std::uint64_t key(const slam::MapPoint& p) const {
    // 21 bits an axis: unique within a tile of 16 m for every voxel that is allowed.
    const auto cell = [&](float x) {
      const auto i = static_cast<std::int64_t>(std::floor(static_cast<double>(x) / voxel_m_));
      return static_cast<std::uint64_t>(i) & 0x1FFFFFU;
    };
    return cell(p.x_m) << 42U | cell(p.y_m) << 21U | cell(p.z_m);
  }
  const double voxel_m_;
  std::unordered_set<std::uint64_t> seen_;
};

/// What goes into the page of one tile.
struct TileSlice {
  std::vector<slam::MapPoint> points;
  std::size_t end = 0;  ///< Points of the tile dealt with.
};

/// The points of `tile` from `offset` on that the query wants, at most `capacity`.
TileSlice slice_tile(const slam::MapTile& tile, std::size_t offset, std::size_t capacity,
                     const MapQuery& query) {
  TileSlice slice;
  Thinner thinner(query.voxel_m);
  std::size_t i = 0;
  for (; i < tile.points.size() && slice.points.size() < capacity; ++i) {
    const slam::MapPoint& point = tile.points[i];
    // Points of earlier pages go through the thinner, too: their voxels are taken.
    if (inside(point, query) && thinner.first(point) && i >= offset) slice.points.push_back(point);
  }
  slice.end = i;
  return slice;
}

Json points_json(const std::vector<slam::MapPoint>& points, bool base64) {
  if (base64) return base64_encode(std::as_bytes(std::span(points)));
  Json out = Json::array();
  for (const slam::MapPoint& p : points) out.push_back(Json{p.x_m, p.y_m, p.z_m, p.intensity});
  return out;
}

/// Tiles that the asker may know and that are no more; all of them on the first page.
Json removed_json(const MapQuery& query, const slam::MapSnapshot& map) {
  Json out = Json::array();
  if (query.cursor || query.since_revision == 0) return out;
  for (const slam::RemovedTile& tile : map.removed) {
    if (tile.revision > query.since_revision) out.push_back(tile.index);
  }
  return out;
}

}  // namespace

MapQuery parse_map_query(const Json& params) {
  MapQuery query;
  query.voxel_m = number_param(params, "voxel_m", 0.0, 0.0, 100.0);
  if (query.voxel_m > 0.0) query.voxel_m = std::max(query.voxel_m, kMinVoxelM);
  query.base64 = choice_param(params, "encoding", "base64|json") == "base64";
  if (const Json* since = find_param(params, "since_revision")) {
    if (!since->is_number_integer() || *since < 0) {
      throw RpcError(kInvalidParams, "since_revision must be the revision of an earlier answer",
                     "since_revision");
    }
    query.since_revision = since->get<std::uint64_t>();
  }
  if (const Json* region = find_param(params, "region")) {
    query.region = {corner(*region, "min_m"), corner(*region, "max_m")};
  }
  if (const Json* cursor = find_param(params, "cursor")) query.cursor = parse_cursor(*cursor);
  return query;
}

std::optional<MapCursor> next_cursor(const Json& page) {
  const Json* text = find_param(page, "next_cursor");
  return text == nullptr ? std::nullopt : std::optional(parse_cursor(*text));
}

Json map_page(const MapQuery& query, const slam::MapSnapshot& map) {
  MapCursor at =
      query.cursor.value_or(MapCursor{map.revision, {INT32_MIN, INT32_MIN, INT32_MIN}, 0});
  if (at.revision < map.moved_revision) {
    throw RpcError(kOutOfRange, "the map was corrected since the first page; ask without cursor",
                   "cursor");
  }
  const std::size_t point_bytes = query.base64 ? kBase64PointBytes : kJsonPointBytes;
  std::size_t room = kPageBytes;
  std::optional<MapCursor> next;
  Json tiles = Json::array();

  for (const auto& tile : map.tiles) {
    if (tile->index < at.tile || tile->revision <= query.since_revision) continue;
    if (!overlaps(tile->index, query)) continue;
    const std::size_t offset = tile->index == at.tile ? at.offset : 0;
    if (room < kTileBytes + point_bytes) {
      next = MapCursor{at.revision, tile->index, offset};
      break;
    }
    const TileSlice slice = slice_tile(*tile, offset, (room - kTileBytes) / point_bytes, query);
    const bool complete = slice.end == tile->points.size();
    room -= kTileBytes + slice.points.size() * point_bytes;
    tiles.push_back(Json{{"index", tile->index},
                         {"revision", tile->revision},
                         {"continued", offset > 0},
                         {"complete", complete},
                         {"count", slice.points.size()},
                         {"points", points_json(slice.points, query.base64)}});
    if (!complete) {
      next = MapCursor{at.revision, tile->index, slice.end};
      break;
    }
  }

  Json out{{"frame", "map"},
           {"map_epoch", map.epoch},
           {"revision", at.revision},
           {"tile_m", slam::kMapTile_m},
           {"encoding", query.base64 ? "base64" : "json"},
           {"tiles", std::move(tiles)},
           {"removed", removed_json(query, map)}};
  if (next) out["next_cursor"] = cursor_text(*next);
  return out;
}

}  // namespace glint::daemon
