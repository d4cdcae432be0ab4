// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/merge/map_join.hpp"

namespace glint::slam {

/// Tells which keyframes of a merged map show nothing that earlier sessions do not show from the
/// same place. Thread-compatible.
class MergedView {
 public:
  /// `map` must outlive this object.
  explicit MergedView(const MapJoin& map) : map_(map), groups_(map.graph().groups()) {}

  /// Takes the keyframes of the map's graph in order: the one of `node`, of the map's session
  /// `session` (from 0). True if it may go. @throws InputError as SessionReader.
  bool adds_nothing(std::size_t node, std::size_t session, const Keyframe& keyframe);

 private:
  struct Kept {
    std::size_t node = 0;
    std::size_t session = 0;
  };
  [[nodiscard]] const Kept* nearest(std::size_t node, std::size_t session) const;

  const MapJoin& map_;
  const std::vector<std::uint32_t> groups_;
  std::vector<Kept> kept_;
};

}  // namespace glint::slam
