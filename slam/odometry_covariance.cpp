// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/odometry_covariance.hpp"

#include <algorithm>

namespace glint::slam {
namespace {

// What odometry gains in a second, as a share of a scan's own covariance.
constexpr double kDriftShare_per_s = 1.2;
constexpr double kLeastShare = 0.04;
// Of an origin: its scan could not be straightened, since nothing was known of its motion.
constexpr double kOriginSigma_m = 0.008;
constexpr double kOriginSigma_rad = 0.0005;
// What a coasted scan adds: metres and radians of unknown acceleration.
constexpr double kCoastedSigma_m = 0.1;
constexpr double kCoastedSigma_rad = 0.05;

using Matrix6 = OdometryCovariance::Matrix6;

// Covariance of a * b, where b's is `increment` and a's is `base`, both right perturbations.
Matrix6 composed(const Matrix6& base, const Pose& b, const Matrix6& increment) {
  const Matrix6 carried = adjoint(b.inverse());
  return carried * base * carried.transpose() + increment;
}

Matrix6 isotropic(double sigma_m, double sigma_rad) {
  Twist sigma;
  sigma << Eigen::Vector3d::Constant(sigma_m), Eigen::Vector3d::Constant(sigma_rad);
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace

void OdometryCovariance::add(const Pose& step, const Matrix6& increment) {
  since_origin_ = composed(since_origin_, step, increment);
  since_keyframe_ = composed(since_keyframe_, step, increment);
}

void OdometryCovariance::reset() { since_origin_ = isotropic(kOriginSigma_m, kOriginSigma_rad); }

void OdometryCovariance::coast() {
  const Matrix6 increment = isotropic(kCoastedSigma_m, kCoastedSigma_rad);
  since_origin_ += increment;
  since_keyframe_ += increment;
}

Matrix6 drift_gained(const Matrix6& own, double span_s) {
  return std::clamp(kDriftShare_per_s * span_s, kLeastShare, kDriftShare_per_s) * own;
}

}  // namespace glint::slam
