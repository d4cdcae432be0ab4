// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <vector>

#include "slam/cold_file.hpp"
#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"

namespace glint::slam {

/// What the search for a loop found at one keyframe.
struct LoopSearch {
  /// From an earlier keyframe to that one first, and to others shortly before it.
  std::vector<LoopEdge> edges;
  std::vector<LoopCandidate> candidates;  ///< Looked into at this keyframe, with the edges' own.
};

/// What knows the places of keyframes. Called by the back end only.
struct LoopSource {
  /// Takes each keyframe, in order, and tells which place seen before it shows. Empty: none is
  /// looked for.
  std::function<LoopSearch(const Keyframe& keyframe)> search = {};
  /// Takes the keyframes of a session that is gone on with, in order, before all others. May be
  /// empty: then only those that were asked about are known.
  std::function<void(const Keyframe& keyframe)> remember = {};

  /// Memory taken by what is known, about, bytes. May be empty: then it is not told.
  std::function<std::size_t()> bytes = {};
  /// Puts what was seen longer ago into the file; it is found as before. May be empty.
  std::function<void(ColdFile& file)> set_aside = {};

  explicit operator bool() const { return static_cast<bool>(search); }
};

}  // namespace glint::slam
