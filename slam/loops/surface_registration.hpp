// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <span>

#include "driver/core/pose.hpp"
#include "slam/joint_optimizer.hpp"
#include "slam/loops/surface_map.hpp"

namespace glint::slam {

/// Weight of a keypoint's squared residual to that of a point on a surface, as a term's weight.
constexpr double kKeypointWeight = 0.1;

struct SurfaceRegistration {
  bool ok = false;
  Pose T_map_scan;
  /// Of T_map_scan, right perturbation, x y z rx ry rz, m^2 and rad^2. Along a weak axis it is what
  /// the keypoints leave open, large without them.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  double overlap = 0.0;  ///< Share of the points that found a surface.
  double rms_m = 0.0;    ///< Of their distances to it.
  int weak_axes = 0;     ///< Directions of translation that the surfaces do not fix.
};

/// Moves a scan's points onto a map's surfaces, and its keypoints onto those of the map: the gate
/// for a surface shrinks from 1 m to 0.3 m. Where the surfaces' normals fix no position along an
/// axis (a corridor's), their chance tilts are not taken for information: the keypoints alone then
/// say where the scan is along it. An axis is fixed when at least `least_aligned` of the points
/// found, as a share, have normals along it. Pure but for planes that `map` finds when asked.
SurfaceRegistration register_on_surfaces(SurfaceMap& map, std::span<const Eigen::Vector3f> points_m,
                                         std::span<const PointTerm> keypoints, const Pose& start,
                                         double least_aligned = 0.02);

}  // namespace glint::slam
