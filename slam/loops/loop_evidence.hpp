// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// Where a keyframe is on its way, by odometry.
struct Waypoint {
  std::uint32_t segment = 0;
  double path_m = 0.0;
  Pose T_odom_sensor;
};

/// Two keyframes that may be at one place, and how they would lie to one another.
struct PlacePair {
  Waypoint older;
  Waypoint current;
  Pose T_older_current;
};

/// What keyframes in a row say for and against loops, and the loops that were believed. One
/// keyframe alone may err: where no picture tells two corridors of one make apart, those a few
/// metres before and after do. Thread-compatible.
class LoopEvidence {
 public:
  void speak_for(const PlacePair& pair);
  void speak_against(const PlacePair& pair);
  /// Whether enough keyframes over enough way, `pair` the last of them, speak for it; `times` as
  /// much as usual.
  [[nodiscard]] bool convincing(const PlacePair& pair, double times = 1.0) const;
  /// What the loop believed last says of a pair: true or false; nothing once it is far back.
  [[nodiscard]] std::optional<bool> foreseen(const PlacePair& pair) const;
  void believe(const PlacePair& loop) { loops_.push_back(loop); }
  [[nodiscard]] const std::vector<PlacePair>& loops() const { return loops_; }

  /// Whether two pairs can both be true: by odometry from older to older and from current to
  /// current keyframe they say the same, but for the drift of such a way; or the older ones are
  /// known to see one place by a loop.
  [[nodiscard]] bool agree(const PlacePair& a, const PlacePair& b) const;

 private:
  [[nodiscard]] bool about(const PlacePair& pair) const;

  std::vector<PlacePair> loops_;
  std::optional<PlacePair> last_;  ///< The last pair that spoke.
  int balance_ = 0;                ///< Those for it less those against it.
  double since_m_ = 0.0;           ///< Path from which on none spoke against it.
};

}  // namespace glint::slam
