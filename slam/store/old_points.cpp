// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/old_points.hpp"

#include <array>
#include <cstdint>
#include <cstring>

namespace glint::slam {

std::vector<MapPoint> points_of_version_1(std::span<const std::byte> bytes) {
  constexpr std::size_t kPointBytes = 7;
  std::vector<MapPoint> points;
  points.reserve(bytes.size() / kPointBytes);
  for (; bytes.size() >= kPointBytes; bytes = bytes.subspan(kPointBytes)) {
    std::array<std::int16_t, 3> cm{};
    std::memcpy(cm.data(), bytes.data(), sizeof cm);
    points.push_back({static_cast<float>(cm[0] * 0.01), static_cast<float>(cm[1] * 0.01),
                      static_cast<float>(cm[2] * 0.01), static_cast<float>(bytes[6])});
  }
  return points;
}

}  // namespace glint::slam
