// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/keyframe.hpp"

namespace glint::slam {

/// Tells what moves from what stands: a point that appears where the keyframes before saw through
/// to something farther away has come there. (What went away since is not looked for.) Cautious: a
/// few degrees around must all have been farther away. Thread-compatible.
class MovingPoints {
 public:
  /// The keyframe's points that stand, as far as the keyframes before can tell. Keyframes of a
  /// segment in their order. Valid until the next call.
  const std::vector<MapPoint>& standing(const Keyframe& keyframe);
  /// Points that were left out so far.
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  /// How far a keyframe saw, by direction.
  struct View {
    std::uint32_t segment = 0;
    Pose T_odom_sensor;
    std::vector<float> range_m;  ///< Least in each cell; infinite where nothing came back.
  };

  [[nodiscard]] static bool saw_through(const View& view, const Eigen::Vector3f& point_m);
  void remember(const Keyframe& keyframe);

  std::deque<View> views_;  ///< Oldest first.
  std::vector<MapPoint> standing_;
  std::uint64_t left_out_ = 0;
};

}  // namespace glint::slam
