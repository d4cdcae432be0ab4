// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// A keyframe in the graph. Value type.
struct GraphNode {
  std::uint64_t id = 0;
  std::uint64_t sequence = 0;  ///< Of its scan.
  std::uint32_t segment = 0;
  Pose T_odom_sensor;
};

}  // namespace glint::slam
