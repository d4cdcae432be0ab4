// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/export/pcd_writer.hpp"

#include <fmt/format.h>

#include <bit>
#include <string>

#include "daemon/cli/text_file.hpp"

namespace glint::cli {

static_assert(std::endian::native == std::endian::little,
              "points are written as they lie in memory");

void write_pcd(const std::filesystem::path& file, std::span<const slam::MapPoint> points) {
  std::string content = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity\n"
      "SIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH {0}\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points.size());
  content.append(reinterpret_cast<const char*>(points.data()), points.size_bytes());
  write_text_file(file, content);
}

}  // namespace glint::cli
