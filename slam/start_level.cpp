// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/start_level.hpp"

namespace glint::slam {
namespace {

// A sensor that is slower than this when odometry begins is at rest.
constexpr double kRest_mps = 0.2;
// The first motions are poor: the first scan could not be straightened.
constexpr int kPoorMotions = 3;
// Odometry's velocities tell a second's change to some 0.05 m/s.
constexpr double kSoonest_s = 0.5;
constexpr double kLongest_s = 2.0;
constexpr double kGravityAtStart_mps2 = 9.80665;

}  // namespace

std::optional<Eigen::Vector3d> StartLevel::add(const Pose& T_odom_from, const Pose& T_odom_to,
                                               const ImuMotion& felt, double span_s) {
  if (done_ || span_s <= 0.0) return std::nullopt;
  const Eigen::Vector3d velocity_mps =
      (T_odom_to.translation_m - T_odom_from.translation_m) / span_s;
  if (++motions_ <= kPoorMotions) {
    done_ = motions_ == kPoorMotions && velocity_mps.norm() < kRest_mps;
    return std::nullopt;
  }
  // From the middle of one motion to the middle of the next.
  const Eigen::Vector3d gained_mps = T_odom_from.rotation * felt.velocity_mps;
  if (motions_ == kPoorMotions + 1) {
    first_mps_ = velocity_mps;
  } else {
    gained_mps_ += 0.5 * (last_gained_mps_ + gained_mps);
    since_s_ += 0.5 * (last_span_s_ + span_s);
  }
  last_gained_mps_ = gained_mps;
  last_span_s_ = span_s;
  if (since_s_ < kSoonest_s) return std::nullopt;
  done_ = since_s_ >= kLongest_s;
  const Eigen::Vector3d fallen_mps = velocity_mps - first_mps_ - gained_mps_;
  return kGravityAtStart_mps2 * fallen_mps.normalized();
}

}  // namespace glint::slam
