// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/cold_file.hpp"
#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"

namespace glint::slam {

/// An older keyframe that shows all that a new one does, nearly from where it is.
struct SeenBefore {
  std::uint64_t keyframe = 0;
  Pose T_older_current;  ///< By the last loop and the odometry since.
};

/// What the search for a loop found at one keyframe.
struct LoopSearch {
  /// From an earlier keyframe to that one first, and to others shortly before it.
  std::vector<LoopEdge> edges;
  std::vector<LoopCandidate> candidates;  ///< Looked into at this keyframe, with the edges' own.
  /// Not looked for again is what the keyframe shows, for another one shows it.
  std::optional<SeenBefore> seen_before;
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
