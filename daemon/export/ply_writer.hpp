// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <span>

#include "slam/map.hpp"

namespace glint::cli {

/// Writes points as a binary PLY with x y z intensity (float32), map frame, m.
/// @throws InputError naming the file.
void write_ply(const std::filesystem::path& file, std::span<const slam::MapPoint> points);

/// All points of a map, tile by tile.
std::vector<slam::MapPoint> map_points(const slam::MapSnapshot& map);

}  // namespace glint::cli
