// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/joint_optimizer.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Below this ratio of smallest to largest curvature a degree of freedom is not seen at all.
constexpr double kSingularJoint = 1e-10;
constexpr double kConverged = 1e-5;

struct NormalEquations {
  Matrix6 plane_hessian = Matrix6::Zero();
  Matrix6 point_hessian = Matrix6::Zero();
  Matrix6 patch_hessian = Matrix6::Zero();
  Matrix6 prior_hessian = Matrix6::Zero();
  Twist gradient = Twist::Zero();
  double plane_squares = 0.0;
  double plane_weight = 0.0;
  double point_squares = 0.0;
  double point_weight = 0.0;
};

double huber_weight(double residual_m, double scale_m) {
  return residual_m <= scale_m ? 1.0 : scale_m / residual_m;
}

// d(n . (R exp(w) x + t + R dt)) is n^T R dt + (x cross R^T n) . w.
void add_planes(std::span<const PlaneTerm> planes, const Pose& pose, double huber_m,
                NormalEquations& sum) {
  const Eigen::Matrix3d to_scan = pose.rotation.conjugate().toRotationMatrix();
  Matrix6& hessian = sum.plane_hessian;
  for (const PlaneTerm& term : planes) {
    const double e = term.normal.dot(pose * term.point_m) - term.offset_m;
    const double w = term.weight * huber_weight(std::abs(e), huber_m);
    Twist j;
    j.head<3>() = to_scan * term.normal;
    j.tail<3>() = term.point_m.cross(j.head<3>());
    const Twist wj = w * j;
    hessian.noalias() += wj * j.transpose();
    sum.gradient += w * e * j;
    sum.plane_squares += w * e * e;
    sum.plane_weight += w;
  }
}

// In the scan frame, where the residual R^T (R x + t - y) has the derivative [I | -skew(x)].
void add_points(std::span<const PointTerm> points, const Pose& pose, double huber_m,
                NormalEquations& sum) {
  const Pose inverse = pose.inverse();
  const Eigen::Matrix3d to_scan = inverse.rotation.toRotationMatrix();
  double weight = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const PointTerm& term : points) {
    const Eigen::Vector3d& x = term.point_m;
    const Eigen::Vector3d e = x - (to_scan * term.fixed_m + inverse.translation_m);
    const double w = term.weight * huber_weight(e.norm(), huber_m);
    const Eigen::Vector3d wx = w * x;
    weight += w;
    moment += wx;
    squares.noalias() += wx * x.transpose();
    sum.gradient.head<3>() += w * e;
    sum.gradient.tail<3>() += wx.cross(e);
    sum.point_squares += w * e.squaredNorm();
  }
  Eigen::Matrix3d skew;
  skew << 0, -moment.z(), moment.y(), moment.z(), 0, -moment.x(), -moment.y(), moment.x(), 0;
  sum.point_weight += weight;
  sum.point_hessian << weight * Eigen::Matrix3d::Identity(), -skew, skew,
      squares.trace() * Eigen::Matrix3d::Identity() - squares;
}

// Close to it, where exp's derivative is that of a sum.
void add_prior(const PosePrior& prior, const Pose& pose, NormalEquations& sum) {
  sum.prior_hessian = prior.information;
  sum.gradient += prior.information * se3_log(prior.T_odom_scan.inverse() * pose);
}

void add_quadratic(const QuadraticTerm& term, const Pose& pose, NormalEquations& sum) {
  sum.patch_hessian = term.hessian;
  sum.gradient += term.gradient + term.hessian * se3_log(term.T_odom_scan.inverse() * pose);
}

NormalEquations linearize(const Pose& pose, const JointTerms& terms, const JointOptions& options) {
  NormalEquations sum;
  add_planes(terms.planes, pose, options.plane_huber_m, sum);
  sum.plane_hessian = terms.plane_projection * sum.plane_hessian * terms.plane_projection;
  sum.gradient = terms.plane_projection * sum.gradient;
  add_points(terms.points, pose, options.point_huber_m, sum);
  if (terms.prior) add_prior(*terms.prior, pose, sum);
  if (terms.patches) add_quadratic(*terms.patches, pose, sum);
  return sum;
}

double root_mean(double squares, double weight) {
  return weight > 0.0 ? std::sqrt(squares / weight) : 0.0;
}

}  // namespace

JointResult optimize_jointly(const Pose& start, const JointTerms& terms,
                             const JointOptions& options) {
  JointResult result;
  Pose pose = start;
  for (int i = 0; i < options.max_iterations; ++i) {
    const NormalEquations sum = linearize(pose, terms, options);
    const Matrix6 hessian =
        sum.plane_hessian + sum.point_hessian + sum.patch_hessian + sum.prior_hessian;
    const Twist step = hessian.ldlt().solve(-sum.gradient);
    if (!step.allFinite()) return result;
    pose.translation_m += pose.rotation * step.head<3>();
    pose.rotation = (pose.rotation * so3_exp(step.tail<3>())).normalized();
    if (step.norm() < kConverged) break;
  }
  const NormalEquations sum = linearize(pose, terms, options);
  result.plane_hessian = sum.plane_hessian;
  result.point_hessian = sum.point_hessian;
  result.patch_hessian = sum.patch_hessian;
  result.prior_hessian = sum.prior_hessian;
  result.plane_rms_m = root_mean(sum.plane_squares, sum.plane_weight);
  result.point_rms_m = root_mean(sum.point_squares, sum.point_weight);
  result.T_odom_scan = pose;
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(result.hessian(), Eigen::EigenvaluesOnly);
  result.ok = pose.translation_m.allFinite() &&
              eigen.eigenvalues()(0) > kSingularJoint * eigen.eigenvalues()(5);
  return result;
}

}  // namespace glint::slam
