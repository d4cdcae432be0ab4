// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <vector>

#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"

namespace glint::slam {

/// What the search for a loop found at one keyframe.
struct LoopSearch {
  /// From an earlier keyframe to that one first, and to others shortly before it.
  std::vector<LoopEdge> edges;
  std::vector<LoopCandidate> candidates;  ///< Looked into at this keyframe, with the edges' own.
};

/// Takes each keyframe, in order, and tells which place seen before it shows. Called by the back
/// end only.
using LoopSource = std::function<LoopSearch(const Keyframe& keyframe)>;

}  // namespace glint::slam
