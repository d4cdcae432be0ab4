// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/blind_drift.hpp"

#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kScansToTell = 3;
// A speed that was known to so much (m/s, and a share of it) changes like this, up to that of
// a vehicle which stops or sets off.
constexpr double kSpeedSigma_mps = 0.05;
constexpr double kSpeedShare = 0.05;
constexpr double kAcceleration_mps2 = 0.5;
constexpr double kLargestSpeedSigma_mps = 1.5;
constexpr double kTurnSigma_radps = 0.1;
// What patches and keypoints carry drifts in one direction for about a second: by this share of the
// way.
constexpr double kCarriedShare = 0.0015;
constexpr double kCarriedFor_s = 1.0;

}  // namespace

double BlindDrift::sigma_m(double blind_s, double speed_mps) const {
  const double grown_mps =
      kSpeedSigma_mps + kSpeedShare * speed_mps + 0.5 * kAcceleration_mps2 * blind_s;
  return std::min(grown_mps, std::max(kLargestSpeedSigma_mps, speed_mps)) * blind_s;
}

Matrix6 BlindDrift::add(const WeakAxes& axes, const Pose& T_odom_scan, const Twist& velocity,
                        double span_s) {
  const bool critical = axes.any_critical();
  in_a_row_ = critical == blind_ ? 0 : in_a_row_ + 1;
  if (in_a_row_ >= kScansToTell) {
    blind_ = critical;
    in_a_row_ = 0;
  }
  Matrix6 added = Matrix6::Zero();
  const double before_s = blind_s_;
  blind_s_ = critical || blind_ ? blind_s_ + std::max(0.0, span_s) : 0.0;
  const double speed_mps = velocity.head<3>().norm();
  const double carried_mps = kCarriedShare * speed_mps;
  const double carried_m2 = carried_mps * carried_mps * kCarriedFor_s * std::max(0.0, span_s);
  const double before_m = sigma_m(before_s, speed_mps);
  const double now_m = sigma_m(blind_s_, speed_mps);
  const double variance_m2 = std::max(0.0, now_m * now_m - before_m * before_m);
  const double now_rad = kTurnSigma_radps * blind_s_;
  const double before_rad = kTurnSigma_radps * before_s;
  const double variance_rad2 = now_rad * now_rad - before_rad * before_rad;
  for (const WeakAxis& axis : axes) {
    const Eigen::Vector3d v = T_odom_scan.rotation.conjugate() * axis.axis;
    const int at = axis.rotation ? 3 : 0;
    double variance = axis.rotation ? variance_rad2 : variance_m2;
    if (!axis.critical) variance = axis.rotation ? 0.0 : carried_m2;
    added.block<3, 3>(at, at) += variance * v * v.transpose();
  }
  return added;
}

}  // namespace glint::slam
