// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace glint {

/// A rigid motion. `T_a_b` takes the coordinates of a point in frame b to frame a: p_a = T_a_b *
/// p_b.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();

  [[nodiscard]] Pose inverse() const {
    const Eigen::Quaterniond r = rotation.conjugate();
    return {r, -(r * translation_m)};
  }
  friend Pose operator*(const Pose& a, const Pose& b) {
    return {(a.rotation * b.rotation).normalized(), a.rotation * b.translation_m + a.translation_m};
  }
  friend Eigen::Vector3d operator*(const Pose& a, const Eigen::Vector3d& p) {
    return a.rotation * p + a.translation_m;
  }
};

/// A tangent vector of SE(3): translation (m) first, then rotation (rad), both in the body frame.
using Twist = Eigen::Matrix<double, 6, 1>;

/// Quaternion of a rotation vector (rad).
Eigen::Quaterniond so3_exp(const Eigen::Vector3d& rotation_rad);
/// Rotation vector (rad, length at most pi) of a unit quaternion.
Eigen::Vector3d so3_log(const Eigen::Quaterniond& rotation);
/// SE(3) exponential and logarithm (Sola 2018, "A micro Lie theory", eqs. 172-176).
Pose se3_exp(const Twist& twist);
Twist se3_log(const Pose& pose);
/// Takes twists, and right perturbations, at b to the same motion seen at a: exp(adjoint(T) x) =
/// T exp(x) T^-1 for T = T_a_b.
Eigen::Matrix<double, 6, 6> adjoint(const Pose& T_a_b);
/// The pose a fraction of the way from `a` (0) to `b` (1) at constant body velocity; extrapolates.
Pose interpolate(const Pose& a, const Pose& b, double fraction);

}  // namespace glint
