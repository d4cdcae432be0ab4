// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// Where a keyframe puts the odometry frame in the map.
struct CorrectionAnchor {
  std::uint32_t segment = 0;
  std::uint64_t sequence = 0;  ///< Of the keyframe's scan.
  Pose T_map_odom;
};

/// How sure the place in a map is that is not added to. Immutable; may be read anywhere.
struct PlaceCertainty {
  Pose T_odom_sensor;  ///< Of the keyframe whose place it is.
  /// Of its T_map_sensor, right perturbation, x y z rx ry rz, m^2 and rad^2.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  /// The same for a scan after it, with what odometry may have erred by on the way.
  [[nodiscard]] Eigen::Matrix<double, 6, 6> covariance_at(const Pose& T_odom_scan) const;
};

/// What the back end tells odometry and clients: where the odometry frame lies in the map frame.
/// `epoch` steps each time it jumps. In a map that is not added to, steps too small to be seen as a
/// jump do not count: it follows the map in them. Immutable; may be read anywhere.
struct MapCorrection {
  /// For what comes after the last anchor: the newest poses, and segments that begin later.
  Pose T_map_odom;
  std::uint32_t epoch = 0;
  /// False while the sensor is looked for in a map that was there before: nothing is known of
  /// T_map_odom then.
  bool placed = true;
  /// How near the search has come to a place that it believes in, 0 to 1.
  double confidence = 1.0;
  /// Of the keyframes until the jump, by segment and sequence; null: T_map_odom holds for all.
  std::shared_ptr<const std::vector<CorrectionAnchor>> anchors;
  /// Null where the map grows: odometry's own covariance is all that is known then.
  std::shared_ptr<const PlaceCertainty> certainty;

  /// Nothing has changed between the two.
  [[nodiscard]] bool same_as(const MapCorrection& other) const {
    return placed == other.placed && confidence == other.confidence && epoch == other.epoch &&
           anchors == other.anchors && certainty == other.certainty;
  }
  /// The pose in the map of the scan `sequence` (a fraction: between two scans): as the keyframes
  /// before and after it in its segment have it, in proportion. At a keyframe, that keyframe's.
  [[nodiscard]] Pose map_pose(std::uint32_t segment, double sequence,
                              const Pose& T_odom_sensor) const;
};

}  // namespace glint::slam
