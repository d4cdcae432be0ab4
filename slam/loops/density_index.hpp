// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/loops/density_map.hpp"
#include "slam/loops/planar_consensus.hpp"
#include "slam/nearest_descriptors.hpp"

namespace glint::slam {

/// An earlier local map that the current one overlaps, and how they lie to one another.
struct DensityHit {
  std::size_t entry = 0;
  Pose T_older_current;  ///< Of the maps' frames: a turn about z and a shift.
  int corners = 0;       ///< That agree on it.
};

/// Earlier local maps seen from above, numbered as they are added. Thread-compatible; buffers are
/// reused.
class DensityIndex {
 public:
  void add(DensityMap map) { maps_.push_back(std::move(map)); }
  /// Those of the `asked` that overlap `current`, the best first; at most a few.
  std::vector<DensityHit> query(const DensityMap& current, std::span<const std::size_t> asked);
  [[nodiscard]] std::size_t size() const { return maps_.size(); }

 private:
  /// An older map with corners that turn alike.
  struct Turning {
    std::size_t entry = 0;
    int corners = 0;
    std::vector<PlanarPair> pairs;
  };

  [[nodiscard]] Turning match(std::size_t entry, const DensityMap& current);

  std::vector<DensityMap> maps_;
  NearestDescriptors nearest_;
};

}  // namespace glint::slam
