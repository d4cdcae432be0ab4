// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <span>

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

struct JointOptions {
  double plane_huber_m = 0.1;
  double point_huber_m = 0.1;
  int max_iterations = 5;
};

struct JointResult {
  bool ok = false;
  Pose T_odom_scan;
  /// Sum of J^T w J of all terms, and of the plane terms alone: translation then rotation, right
  /// perturbation.
  Eigen::Matrix<double, 6, 6> hessian = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> plane_hessian = Eigen::Matrix<double, 6, 6>::Zero();
  double plane_rms_m = 0.0;  ///< Robustly weighted.
  double point_rms_m = 0.0;
  double step_m = 0.0;  ///< Length of the last step's translation.
};

/// argmin over T of sum rho(w |f_b|^2) + sum rho(w f_s^2), by Gauss-Newton with Huber kernels: the
/// paper prints the plain sums of the residuals, which have no minimum. The associations stay as
/// they are. Not ok when the terms do not fix all six degrees of freedom.
/// Pure: any thread, no state.
JointResult optimize_jointly(const Pose& start, std::span<const PlaneTerm> planes,
                             std::span<const PointTerm> points, const JointOptions& options = {});

}  // namespace glint::slam
