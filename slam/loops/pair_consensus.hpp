// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/motion_estimation.hpp"

namespace glint::slam {

struct ConsensusOptions {
  /// A pair agrees when it lies within base + share * range (the keypoint's pixel is as wide).
  double gate_m = 0.15;
  double gate_share = 0.01;
  int hypotheses = 600;  ///< Samples of three pairs.
};

struct Consensus {
  Pose T_reference_current;
  std::vector<PointPair> inliers;  ///< Empty if no motion was found.
  int sectors = 0;                 ///< Of eight around the current sensor, how many hold an inlier.
};

/// The rigid motion that most of the pairs agree on, by samples of three [Fischler & Bolles 1981,
/// "Random sample consensus"], then fitted to those that do. Any motion: nothing need be known of
/// it. The same pairs give the same result. Pure: any thread, no state.
Consensus find_consensus(std::span<const PointPair> pairs, const ConsensusOptions& options = {});

}  // namespace glint::slam
