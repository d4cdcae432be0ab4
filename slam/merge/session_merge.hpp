// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>

#include "driver/core/clock.hpp"

namespace glint::slam {

/// Sessions that do not show one place in common; the message names them and what to do.
class NoOverlapError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What became of sessions that were merged.
struct MergeSummary {
  std::size_t sessions = 0;
  std::size_t kept = 0;     ///< Keyframes with all that they show.
  std::size_t thinned = 0;  ///< Keyframes that are left as poses: an earlier session's show it.
  std::size_t joints = 0;   ///< Loops between two sessions.
  std::size_t loops = 0;    ///< All loops, these among them.
  double seconds = 0.0;     ///< What it took, by the clock that was given.
};

/// Makes one session of several that overlap, each with one of the others at least, in any order:
/// where, it finds without a guess (MapJoin). The frame, and how the map is made of the keyframes,
/// are those of the first. Keyframes that stand within 0.5 m and 15 degrees of one of another
/// session and show the same stay in the graph, without points and keypoints. Of events one of kind
/// `merge` is left. Sessions are only read; `target` gets its name once it is whole and on the
/// disk, in place of what had it, and is none of them. To be called from a thread that may wait.
/// @throws NoOverlapError, and then nothing is written; InputError that names the file where one
/// cannot be read, holds no keyframe, or `target` cannot be written.
MergeSummary merge_sessions(std::span<const std::filesystem::path> sessions,
                            const std::filesystem::path& target, Clock clock = {});

}  // namespace glint::slam
