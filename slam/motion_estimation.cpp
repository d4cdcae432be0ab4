// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/motion_estimation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Below this ratio of smallest to largest curvature a degree of freedom is not seen at all
// (all pairs on one line, or at one point).
constexpr double kSingular = 1e-9;

Eigen::Vector3d residual_m(const PointPair& pair, const Pose& pose) {
  return pair.reference_m - pose * pair.current_m;
}

// Derivative of R exp(dtheta) X + T + R dt, negated, as the residual is Y minus it.
Eigen::Matrix<double, 3, 6> jacobian(const PointPair& pair, const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d& x = pair.current_m;
  Eigen::Matrix3d skew;
  skew << 0, -x.z(), x.y(), x.z(), 0, -x.x(), -x.y(), x.x(), 0;
  Eigen::Matrix<double, 3, 6> j;
  j.leftCols<3>() = -rotation;
  j.rightCols<3>() = rotation * skew;
  return j;
}

struct NormalEquations {
  Matrix6 hessian = Matrix6::Zero();
  Twist gradient = Twist::Zero();
  double weight = 0.0;
  double weighted_squares = 0.0;
};

NormalEquations linearize(const std::vector<PointPair>& pairs, const Pose& pose, double huber_m) {
  NormalEquations sum;
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d e = residual_m(pair, pose);
    const double weighted_norm_m = pair.score * e.norm();
    const double huber = weighted_norm_m <= huber_m ? 1.0 : huber_m / weighted_norm_m;
    const double w = pair.score * pair.score * huber;
    const auto j = jacobian(pair, rotation);
    sum.hessian += w * j.transpose() * j;
    sum.gradient += w * j.transpose() * e;
    sum.weight += w;
    sum.weighted_squares += w * e.squaredNorm();
  }
  return sum;
}

double truncated_cost(const std::vector<PointPair>& pairs, const Pose& pose, double gate_m) {
  double cost = 0.0;
  const double gate2 = gate_m * gate_m;
  for (const PointPair& pair : pairs) {
    cost += pair.score * std::min(residual_m(pair, pose).squaredNorm(), gate2);
  }
  return cost;
}

}  // namespace

Pose weighted_umeyama(const std::vector<PointPair>& pairs) {
  double total = 0.0;
  Eigen::Vector3d mean_y = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_x = Eigen::Vector3d::Zero();
  for (const PointPair& pair : pairs) {
    const double w = pair.score * pair.score;
    total += w;
    mean_y += w * pair.reference_m;
    mean_x += w * pair.current_m;
  }
  mean_y /= total;
  mean_x /= total;
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (const PointPair& pair : pairs) {
    const double w = pair.score * pair.score;
    cross += w * (pair.reference_m - mean_y) * (pair.current_m - mean_x).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1.0, 1.0, 1.0);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign.z() = -1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  Pose pose;
  pose.rotation = Eigen::Quaterniond(rotation).normalized();
  pose.translation_m = mean_y - pose.rotation * mean_x;
  return pose;
}

Pose Registrar::robust_start(const std::vector<PointPair>& pairs, const Pose& predicted) {
  Pose best = predicted;
  double best_cost = truncated_cost(pairs, best, options_.inlier_m);
  std::mt19937 random(12345);  // The same samples each time: results repeat bit for bit.
  const auto size = static_cast<std::uint32_t>(pairs.size());
  std::vector<PointPair> sample(3);
  for (int hypothesis = 0; hypothesis < options_.hypotheses; ++hypothesis) {
    std::array<std::uint32_t, 3> pick{};
    // Not std::uniform_int_distribution: its sequence is the library's own affair.
    for (auto& p : pick) p = static_cast<std::uint32_t>(random()) % size;
    if (pick[0] == pick[1] || pick[1] == pick[2] || pick[0] == pick[2]) continue;
    bool rigid = true;
    for (std::size_t i = 0; i < 3; ++i) sample[i] = pairs[pick[i]];
    for (std::size_t i = 0; i < 3 && rigid; ++i) {
      const PointPair& a = sample[i];
      const PointPair& b = sample[(i + 1) % 3];
      const double length_y_m = (a.reference_m - b.reference_m).norm();
      const double length_x_m = (a.current_m - b.current_m).norm();
      rigid = std::abs(length_y_m - length_x_m) < options_.inlier_m;
    }
    if (!rigid) continue;
    const Pose pose = weighted_umeyama(sample);
    const double cost = truncated_cost(pairs, pose, options_.inlier_m);
    if (cost < best_cost) {
      best_cost = cost;
      best = pose;
    }
  }
  return best;
}

void Registrar::select_inliers(const std::vector<PointPair>& pairs, const Pose& pose) {
  inliers_.clear();
  for (const PointPair& pair : pairs) {
    if (residual_m(pair, pose).norm() < options_.inlier_m) inliers_.push_back(pair);
  }
}

Registration Registrar::align(const std::vector<PointPair>& pairs, const Pose& predicted) {
  if (pairs.size() < 3) return {};
  select_inliers(pairs, predicted);
  const double borne_out = static_cast<double>(inliers_.size()) / static_cast<double>(pairs.size());
  if (borne_out < options_.convincing_share) select_inliers(pairs, robust_start(pairs, predicted));
  if (inliers_.size() < 3) return {};
  return refine(pairs, weighted_umeyama(inliers_));
}

Registration Registrar::refine(const std::vector<PointPair>& pairs, const Pose& start) {
  select_inliers(pairs, start);
  if (static_cast<int>(inliers_.size()) < std::max(3, options_.min_inliers)) return {};
  return solve(start);
}

Registration Registrar::solve(Pose pose) {
  for (int i = 0; i < options_.max_iterations; ++i) {
    const NormalEquations sum = linearize(inliers_, pose, options_.huber_m);
    const Twist step = sum.hessian.ldlt().solve(-sum.gradient);
    if (!step.allFinite()) return {};
    pose.translation_m += pose.rotation * step.head<3>();
    pose.rotation = (pose.rotation * so3_exp(step.tail<3>())).normalized();
    if (step.norm() < 1e-8) break;
  }

  const NormalEquations sum = linearize(inliers_, pose, options_.huber_m);
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(sum.hessian, Eigen::EigenvaluesOnly);
  if (!(eigen.eigenvalues()(0) > kSingular * eigen.eigenvalues()(5))) return {};
  const auto count = static_cast<double>(inliers_.size());
  const double freedom = std::max(1.0, 3.0 * count - 6.0);
  Registration result;
  // Variance of a residual of unit weight, times the inverse of the curvature.
  result.covariance = sum.weighted_squares / freedom * sum.hessian.inverse();
  result.rms_m = std::sqrt(sum.weighted_squares / sum.weight);
  result.T_reference_current = pose;
  result.inliers = static_cast<int>(inliers_.size());
  result.ok = result.covariance.allFinite() && pose.translation_m.allFinite();
  return result;
}

}  // namespace glint::slam
