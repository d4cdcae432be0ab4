// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>

#include "daemon/protocol.hpp"
#include "slam/map.hpp"

namespace glint::daemon {

/// Where the next page of the map begins, and what the whole answer was asked with.
struct MapCursor {
  std::uint64_t revision = 0;  ///< Of the map when the first page was made.
  slam::TileIndex tile{};
  std::size_t offset = 0;  ///< Points of that tile which earlier pages dealt with.
};

/// get_map's parameters. Value type.
struct MapQuery {
  double voxel_m = 0.0;                                  ///< 0: as kept.
  std::optional<std::array<Eigen::Vector3d, 2>> region;  ///< Lower and upper corner, map frame, m.
  std::uint64_t since_revision = 0;
  std::optional<MapCursor> cursor;
  bool base64 = true;
};

/// @throws RpcError.
MapQuery parse_map_query(const Json& params);

/// One page: as many tiles, and points of the last one, as a line holds. Tiles only gain points
/// while a client pages, so that no page misses or repeats one; a cursor from before a correction
/// of the map, which moves all, is refused. @throws RpcError.
Json map_page(const MapQuery& query, const slam::MapSnapshot& map);

/// Where the page after this one begins; null where it is the last.
std::optional<MapCursor> next_cursor(const Json& page);

}  // namespace glint::daemon
