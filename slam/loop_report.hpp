// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "driver/core/time.hpp"
#include "slam/loop_edge.hpp"
#include "slam/pose_graph.hpp"

namespace glint::slam {

/// How far a correction moved the keyframe that it moved most.
struct LargestCorrection {
  double distance_m = 0.0;
  double angle_rad = 0.0;
};

/// What became of a candidate for a loop. One that was accepted may later be refused in a second
/// report, when others contradict it.
struct LoopReport {
  SensorTime stamp;  ///< Of the keyframe that brought it up.
  LoopCandidate candidate;
  std::optional<LoopMisfit> before;  ///< Of an edge: by the poses as they were,
  std::optional<LoopMisfit> after;   ///< and as it left them.
  LargestCorrection correction;      ///< What it did to the poses; zero where nothing moved.
};

/// The figures, as in the session file's and the clients' events of kind `loop`.
nlohmann::ordered_json to_json(const LoopReport& report);

}  // namespace glint::slam
