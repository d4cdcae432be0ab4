// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <span>

#include "slam/loop_edge.hpp"
#include "slam/loops/pair_consensus.hpp"
#include "slam/loops/place.hpp"
#include "slam/loops/surface_registration.hpp"
#include "slam/matching.hpp"

namespace glint::slam {

struct LoopVerifierOptions {
  MatchOptions match{64, 1.0, 500};
  ConsensusOptions consensus;
  int min_inliers = 20;
  double min_inlier_share = 0.4;
  int min_sectors = 3;  ///< Of eight.
  double min_overlap = 0.4;
  double min_overlap_by_shape = 0.6;
  double least_aligned_by_shape = 0.04;    ///< Share of the points that fixes an axis.
  double max_rms_m = 0.09;                 ///< Where points lie close.
  double max_rms_share = 0.25;             ///< Of the points' spacing, where that is more.
  std::size_t registered_points = 1000;    ///< Of the current place, at most.
  std::size_t registered_by_shape = 1500;  ///< Of all that are taken together, at most.
};

/// Whether two keyframes were taken at one place, and how they lie to one another: keypoints that
/// look alike must agree on a motion [Fischler & Bolles 1981], and the surfaces of the one must lie
/// on those around the other. When in doubt it is no loop. Thread-compatible; buffers are reused.
class LoopVerifier {
 public:
  explicit LoopVerifier(LoopVerifierOptions options = {});

  /// The first step: matched keypoints. Fills the figures of `candidate` and its reason if it
  /// fails.
  Consensus match(const Place& older, const Place& current, LoopCandidate& candidate);
  /// The second step, with the keyframes before and after the older one (in order, the older one
  /// too, all of one segment): fills the figures and `edge`, or the reason. True: accepted.
  bool registered(const Place& older, std::span<const Place> around, const Place& current,
                  const Consensus& start, LoopCandidate& candidate, LoopEdge& edge);
  /// The same without keypoints: the points of the keyframes just before `current` (in order, it
  /// too, the last) must lie on the surfaces, more of them than above, and these alone must fix
  /// the motion from `T_older_current` on.
  bool registered_by_shape(const Place& older, std::span<const Place> around, const Place& current,
                           std::span<const Place> before, const Pose& T_older_current,
                           LoopCandidate& candidate, LoopEdge& edge);

 private:
  bool judge(const SurfaceRegistration& found, const Place& older, const Place& current,
             double min_overlap, LoopCandidate& candidate, LoopEdge& edge) const;

  LoopVerifierOptions options_;
  Matcher matcher_;
};

}  // namespace glint::slam
