// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>

#include "slam/config.hpp"
#include "slam/odometry_estimate.hpp"

namespace glint::slam {

/// Decides which scans become keyframes: far enough, turned enough, or few matches left since the
/// last one [Du & Beltrame 2023, sec. III-C]. A standing sensor makes none. Thread-compatible.
class KeyframeSelector {
 public:
  explicit KeyframeSelector(const SlamConfig& config)
      : distance_m_(config.keyframe_distance_m),
        angle_rad_(config.keyframe_angle_rad),
        min_matches_(config.keyframe_min_matches) {}

  /// True when this estimate should be kept; it is then the one to compare the next ones with.
  bool select(const OdometryEstimate& estimate);
  void reset() { last_.reset(); }

 private:
  double distance_m_;
  double angle_rad_;
  int min_matches_;
  std::optional<OdometryEstimate> last_;
};

}  // namespace glint::slam
