// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map_correction.hpp"

#include <algorithm>
#include <utility>

namespace glint::slam {

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
