// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/loop_edge.hpp"
#include "slam/store/session_event.hpp"

namespace glint::slam {

/// What closing loops changes in the session file.
struct LoopChanges {
  std::vector<SessionEvent> events;
  std::vector<LoopEdge> added;
  std::vector<LoopEdge> removed;
  /// Keyframes and their new T_map_sensor.
  std::vector<std::pair<std::uint64_t, Pose>> poses;
};

}  // namespace glint::slam
