// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/scan_motion.hpp"

#include <algorithm>

namespace glint::slam {

Pose ScanMotion::at(SensorTime t) const {
  const std::int64_t ahead_ns = std::clamp(t - reference_, -longest_ns_, longest_ns_);
  const double ahead_s = static_cast<double>(ahead_ns) * kSecondsPerNs;
  const auto measured =
      imu_ != nullptr ? imu_->between(reference_, reference_ + ahead_ns) : std::nullopt;
  return measured ? carried_on(state_, *measured, ahead_s) : se3_exp(state_.velocity * ahead_s);
}

Pose carried_on(const MotionState& state, const ImuMotion& imu, double span_s) {
  const Eigen::Vector3d velocity_mps = state.velocity.head<3>();
  if (state.gravity_mps2.isZero(0.0)) {
    // A body that turns evenly moves, on average, in the direction it has half way.
    const Eigen::Quaterniond half = Eigen::Quaterniond::Identity().slerp(0.5, imu.turn);
    return {imu.turn, half * (velocity_mps * span_s)};
  }
  return {imu.turn, velocity_mps * span_s + 0.5 * span_s * span_s * state.gravity_mps2 + imu.way_m};
}

void place_columns(const ScanMotion& motion, std::span<const SensorTime> column_times,
                   std::vector<Pose>& T_reference_column) {
  T_reference_column.resize(column_times.size());
  for (std::size_t m = 0; m < column_times.size(); ++m) {
    T_reference_column[m] = motion.at(column_times[m]);
  }
}

}  // namespace glint::slam
