// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map_correction.hpp"

#include <algorithm>
#include <utility>

namespace glint::slam {
namespace {

// What odometry errs by on the way from a keyframe to the scans before the next one.
constexpr double kWayShare = 0.01;
constexpr double kWayTurn_rad = 0.002;

}  // namespace

Eigen::Matrix<double, 6, 6> PlaceCertainty::covariance_at(const Pose& T_odom_scan) const {
  const Pose T_scan_keyframe = T_odom_scan.inverse() * T_odom_sensor;
  const Eigen::Matrix<double, 6, 6> carried = adjoint(T_scan_keyframe);
  const double way_m = T_scan_keyframe.translation_m.norm();
  Twist gained = Twist::Zero();
  if (way_m > 0.0) {
    gained.head<3>().setConstant(kWayShare * kWayShare * way_m * way_m);
    gained.tail<3>().setConstant(kWayTurn_rad * kWayTurn_rad);
  }
  return carried * covariance * carried.transpose() +
         Eigen::Matrix<double, 6, 6>(gained.asDiagonal());
}

Pose MapCorrection::map_pose(std::uint32_t segment, double sequence,
                             const Pose& T_odom_sensor) const {
  if (!anchors || anchors->empty()) return T_map_odom * T_odom_sensor;
  const auto after = std::upper_bound(
      anchors->begin(), anchors->end(), std::pair(segment, sequence),
      [](const auto& wanted, const CorrectionAnchor& anchor) {
        return wanted < std::pair(anchor.segment, static_cast<double>(anchor.sequence));
      });
  if (after == anchors->end()) return T_map_odom * T_odom_sensor;
  const bool follows = after != anchors->begin() && std::prev(after)->segment == segment;
  // Before the first keyframe of its segment.
  if (!follows) {
    const bool leads = after->segment == segment || after == anchors->begin();
    return (leads ? after : std::prev(after))->T_map_odom * T_odom_sensor;
  }
  const CorrectionAnchor& a = *std::prev(after);
  if (after->segment != segment) return a.T_map_odom * T_odom_sensor;
  const auto begin = static_cast<double>(a.sequence);
  const double fraction = (sequence - begin) / (static_cast<double>(after->sequence) - begin);
  // Between where one and the other put the sensor: exact at both, however far the origin is.
  return interpolate(a.T_map_odom * T_odom_sensor, after->T_map_odom * T_odom_sensor, fraction);
}

}  // namespace glint::slam
