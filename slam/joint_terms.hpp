// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// A point of the scan and the plane that the map has near it. The residual f_s is the point's
/// distance from the plane [Du & Beltrame 2023, sec. III-B, scan-to-map].
struct PlaneTerm {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< Scan frame.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Odometry frame, unit length.
  double offset_m = 0.0;                              ///< Of the plane: normal . x = offset.
  double weight = 1.0;                                ///< Of the squared residual.
};

/// A keypoint of the scan and the same keypoint where a fixed, older scan saw it. The residual f_b
/// is their difference [Du & Beltrame 2023, sec. III-B, LiDAR bundle adjustment].
struct PointTerm {
  Eigen::Vector3d point_m;  ///< Scan frame.
  Eigen::Vector3d fixed_m;  ///< Odometry frame.
  double weight = 1.0;
};

/// What is known of the pose near one that it was looked at from: half of d^T hessian d + gradient
/// . d for T_odom_scan * exp(d).
struct QuadraticTerm {
  Pose T_odom_scan;
  Eigen::Matrix<double, 6, 6> hessian = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
};

}  // namespace glint::slam
