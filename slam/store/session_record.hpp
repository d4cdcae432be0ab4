// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"
#include "slam/store/loop_changes.hpp"
#include "slam/store/value_codec.hpp"

namespace glint::slam {

/// A keyframe on its way to the session file, packed: a tenth of the memory it takes itself.
struct KeyframeRecord {
  std::uint64_t id = 0;
  OdometryEstimate estimate;
  Pose T_map_sensor;
  std::optional<FeltGravity> gravity;
  std::vector<std::byte> points;
  std::vector<std::byte> features;
  std::optional<std::vector<std::byte>> words;
  std::optional<LoopEdge> odometry;  ///< From the keyframe before; null for the first of a segment.
};

/// A line of `meta`.
struct MetaRecord {
  std::string key;
  std::string value;
};

/// The sensor that keyframes from `first_keyframe` on are of.
struct SensorRecord {
  std::uint64_t first_keyframe = 0;
  std::string metadata;
};

/// One thing that the session file will hold.
using SessionRecord = std::variant<KeyframeRecord, MetaRecord, SensorRecord, LoopChanges>;

/// About what a record takes in memory.
std::size_t bytes_of(const SessionRecord& record);

}  // namespace glint::slam
