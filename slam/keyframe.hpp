// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/features.hpp"
#include "slam/gravity_estimate.hpp"
#include "slam/odometry_estimate.hpp"

namespace glint::slam {

/// A point with its intensity (channel units scaled to 0-255), float as on the wire and in exports.
struct MapPoint {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float z_m = 0.0F;
  float intensity = 0.0F;
};

/// A scan worth keeping: what the back end builds the map, loops and session from. Value type.
struct Keyframe {
  std::uint64_t id = 0;  ///< 0, 1, 2, ... in order.
  OdometryEstimate estimate;
  /// Points in the sensor frame at estimate.stamp (motion compensated), m.
  std::vector<MapPoint> points;
  /// The keypoints of its intensity image; `points_m` as `points` above.
  Features features;
  /// Covariance of the motion since the keyframe before it, as that of an OdometryEstimate: the
  /// odometry edge of the pose graph. Meaningless for the first one of a segment.
  Eigen::Matrix<double, 6, 6> edge_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  /// Where up is at estimate.stamp, where an IMU told.
  std::optional<FeltGravity> gravity;
  /// Taken only to find its place in the map: nothing is to be built from it, and its id is that of
  /// the keyframe that comes next.
  bool probe = false;
};

/// A keyframe that is a pose in the graph and nothing else: what it saw others show.
inline bool is_bare(const Keyframe& keyframe) {
  return keyframe.points.empty() && keyframe.features.size() == 0;
}

}  // namespace glint::slam
