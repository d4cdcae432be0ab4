// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/gravity_factor.hpp"

#include <Eigen/Cholesky>

namespace glint::slam {
namespace {

constexpr int kFitRounds = 4;

// R^T up + M b - u, in the node's frame.
Eigen::Vector3d gravity_misfit(const GravityFactor& factor, const Pose& pose,
                               const GravityFit& fit) {
  return pose.rotation.conjugate() * fit.up + factor.felt.bias_share * fit.bias - factor.felt.up;
}

}  // namespace

GravityFit fit_gravity(std::span<const GravityFactor> factors, std::span<const Pose> poses) {
  GravityFit fit;
  for (int round = 0; round < kFitRounds; ++round) {
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    normal.bottomRightCorner<3, 3>().diagonal().setConstant(
        1.0 / (kAccelerometerBias * kAccelerometerBias));
    for (const GravityFactor& factor : factors) {
      const Pose& pose = poses[factor.node];
      const double variance = factor.felt.sigma_rad * factor.felt.sigma_rad;
      double weight = 1.0 / variance;
      if (round > 0) weight /= 1.0 + gravity_misfit(factor, pose, fit).squaredNorm() / variance;
      const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
      Eigen::Matrix<double, 3, 6> by;
      by << Eigen::Matrix3d::Identity(), rotation * factor.felt.bias_share;
      normal += weight * by.transpose() * by;
      right += weight * by.transpose() * (rotation * factor.felt.up);
    }
    const Eigen::Matrix<double, 6, 1> found = normal.ldlt().solve(right);
    fit = {found.head<3>().normalized(), found.tail<3>()};
  }
  return fit;
}

double tilt_rad(const GravityFactor& factor, const Pose& T_map_node, const GravityFit& fit) {
  return gravity_misfit(factor, T_map_node, fit).cross(factor.felt.up).norm();
}

}  // namespace glint::slam
