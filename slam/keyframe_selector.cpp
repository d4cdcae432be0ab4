// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/keyframe_selector.hpp"

namespace glint::slam {
namespace {

// Never more often than this, so that the back end keeps up with any motion.
constexpr std::int64_t kShortestInterval_ns = 200'000'000;
// Few matches while all but standing still mean a poor scene, not a new place.
constexpr double kStandingShare = 0.2;

}  // namespace

bool KeyframeSelector::select(const OdometryEstimate& estimate) {
  if (last_ && last_->segment == estimate.segment) {
    const Pose motion = last_->T_odom_sensor.inverse() * estimate.T_odom_sensor;
    const double distance_m = motion.translation_m.norm();
    const double angle_rad = so3_log(motion.rotation).norm();
    const bool far = distance_m > distance_m_ || angle_rad > angle_rad_;
    const bool moving =
        distance_m > kStandingShare * distance_m_ || angle_rad > kStandingShare * angle_rad_;
    const bool thin = moving && estimate.matches < min_matches_;
    const std::int64_t interval_ns = estimate.stamp - last_->stamp;
    if (interval_ns >= 0 && interval_ns < kShortestInterval_ns) return false;
    if (!far && !thin) return false;
  }
  last_ = estimate;
  return true;
}

}  // namespace glint::slam
