// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "driver/core/pose.hpp"
#include "slam/joint_terms.hpp"

namespace glint::slam {

/// Where the scan is thought to be before it is looked at.
struct PosePrior {
  Pose T_odom_scan;
  /// Translation then rotation, right perturbation; in the units of the terms' weights.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  /// Besides, but only along axes that surfaces hold: optimize_jointly() takes `information` alone.
  Eigen::Matrix<double, 6, 6> held_information = Eigen::Matrix<double, 6, 6>::Zero();
  bool turn_is_measured = false;  ///< By a gyroscope; else it was only expected to go on.
};

/// What is known of one scan's pose.
struct JointTerms {
  std::span<const PlaneTerm> planes;
  std::span<const PointTerm> points;
  /// Takes out what the planes must not say, see projection_without().
  Eigen::Matrix<double, 6, 6> plane_projection = Eigen::Matrix<double, 6, 6>::Identity();
  std::optional<PosePrior> prior{};
  std::optional<QuadraticTerm> patches{};
};

struct JointOptions {
  double plane_huber_m = 0.1;
  double point_huber_m = 0.1;
  int max_iterations = 5;
};

struct JointResult {
  bool ok = false;
  Pose T_odom_scan;
  /// Sum of J^T w J of plane terms (projected), of point terms and patches, the prior's
  /// information: translation then rotation, right perturbation.
  Eigen::Matrix<double, 6, 6> plane_hessian = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> point_hessian = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> patch_hessian = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> prior_hessian = Eigen::Matrix<double, 6, 6>::Zero();
  double plane_rms_m = 0.0;  ///< Robustly weighted.
  double point_rms_m = 0.0;

  [[nodiscard]] Eigen::Matrix<double, 6, 6> hessian() const {
    return plane_hessian + point_hessian + patch_hessian + prior_hessian;
  }
};

/// argmin over T of sum rho(w |f_b|^2) + sum rho(w f_s^2) (+ the prior's |T_prior^-1 T|^2), by
/// Gauss-Newton with Huber kernels: the paper prints the plain sums of the residuals, which have no
/// minimum. The associations stay as they are. Not ok when the terms do not fix all six degrees of
/// freedom. Pure: any thread, no state.
JointResult optimize_jointly(const Pose& start, const JointTerms& terms,
                             const JointOptions& options = {});

}  // namespace glint::slam
