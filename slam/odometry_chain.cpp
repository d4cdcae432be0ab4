// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/odometry_chain.hpp"

#include <Eigen/Cholesky>

namespace glint::slam {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

OdometryChain::OdometryChain(std::span<const Pose> T_odom, std::span<const Matrix6> covariances) {
  T_first_.reserve(T_odom.size());
  covariance_.reserve(T_odom.size());
  T_first_.emplace_back();
  covariance_.emplace_back(Matrix6::Zero());
  const Pose T_first_odom = T_odom.front().inverse();
  for (std::size_t i = 1; i < T_odom.size(); ++i) {
    const Matrix6 carried = adjoint(T_odom[i].inverse() * T_odom[i - 1]);
    T_first_.push_back(T_first_odom * T_odom[i]);
    covariance_.emplace_back(carried * covariance_.back() * carried.transpose() + covariances[i]);
  }
}

// The last keyframe is found to be off by e; what the i-th is off by, given that, is the mean of a
// Gaussian: their covariance is the i-th's own, carried to the last.
void OdometryChain::spread(std::span<Pose> poses) const {
  const std::size_t last = T_first_.size() - 1;
  const Twist off = se3_log(T_first_[last].inverse() * (poses.front().inverse() * poses[last]));
  const Twist pull = covariance_[last].ldlt().solve(off);
  for (std::size_t i = 1; i < last; ++i) {
    const Matrix6 to_last = adjoint(T_first_[last].inverse() * T_first_[i]);
    const Twist share = covariance_[i] * (to_last.transpose() * pull);
    poses[i] = poses.front() * T_first_[i] * se3_exp(share);
  }
}

}  // namespace glint::slam
