// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <span>

#include "driver/core/pose.hpp"
#include "slam/loops/place.hpp"

namespace glint::slam {

/// What the keypoints of one place say of another that should be the same.
struct Comparison {
  double confirmed = 0.0;  ///< Share of the keypoints that are found where they should be.
  /// Cubes full of keypoints of which next to none is found, though others are: here the two places
  /// show different things.
  int contradictions = 0;
};

/// Looks for each keypoint of `seen` where it should be among those of `known` and of the keyframes
/// `around` it (itself too, all of one segment), which see more together. Two places of the same
/// make agree on most of their keypoints: it is the picture that hangs in one of them alone that
/// tells them apart. Pure: any thread, no state.
Comparison compare_places(const Place& known, std::span<const Place> around, const Place& seen,
                          const Pose& T_known_seen);

}  // namespace glint::slam
