// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/export/ply_writer.hpp"

#include <fmt/format.h>

#include <bit>
#include <string>

#include "daemon/cli/text_file.hpp"

namespace glint::cli {

static_assert(std::endian::native == std::endian::little,
              "points are written as they lie in memory");
static_assert(sizeof(slam::MapPoint) == 4 * sizeof(float));

void write_ply(const std::filesystem::path& file, std::span<const slam::MapPoint> points) {
  std::string content = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment map frame, metres\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\nproperty float intensity\n"
      "end_header\n",
      points.size());
  content.append(reinterpret_cast<const char*>(points.data()), points.size_bytes());
  write_text_file(file, content);
}

std::vector<slam::MapPoint> map_points(const slam::MapSnapshot& map) {
  std::vector<slam::MapPoint> points;
  points.reserve(map.point_count);
  for (const auto& tile : map.tiles) {
    points.insert(points.end(), tile->points.begin(), tile->points.end());
  }
  return points;
}

}  // namespace glint::cli
