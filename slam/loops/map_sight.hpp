// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <optional>

#include "slam/loops/loop_verifier.hpp"
#include "slam/loops/place_shelf.hpp"

namespace glint::slam {

/// Where a scan lies on a map.
struct MapFix {
  Pose T_map_sensor;
  /// Of T_map_sensor, right perturbation, x y z rx ry rz, m^2 and rad^2; large along an axis that
  /// neither surfaces nor keypoints fix.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  double overlap = 0.0;  ///< Share of the points that found a surface.
  double rms_m = 0.0;    ///< Of their distances to it.
};

/// Looks at the map around a pose that is roughly known: a scan's points are laid on the surfaces
/// of the keyframes nearest to it, its keypoints on those of the nearest ones that show the same.
/// Thread-compatible; buffers are reused.
class MapSight {
 public:
  /// `places`: the map's. `guess`: T_map_sensor of the scan, to within
  /// some 0.5 m. Null where the scan does not lie on the map, or the map is not there.
  std::optional<MapFix> fix(PlaceShelf& places, const Place& scan, const Pose& guess);

 private:
  LoopVerifier verifier_;
};

}  // namespace glint::slam
