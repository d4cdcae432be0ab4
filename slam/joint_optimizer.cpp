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
constexpr double kSingular = 1e-10;
constexpr double kConverged = 1e-6;

struct NormalEquations {
  Matrix6 plane_hessian = Matrix6::Zero();
  Matrix6 point_hessian = Matrix6::Zero();
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
    hessian.selfadjointView<Eigen::Lower>().rankUpdate(j, w);
    sum.gradient += w * e * j;
    sum.plane_squares += w * e * e;
    sum.plane_weight += w;
  }
  hessian.triangularView<Eigen::StrictlyUpper>() = hessian.transpose();
}

// In the scan frame, where the residual R^T (R x + t - y) has the derivative [I | -skew(x)].
void add_points(std::span<const PointTerm> points, const Pose& pose, double huber_m,
                NormalEquations& sum) {
  const Pose inverse = pose.inverse();
  for (const PointTerm& term : points) {
    const Eigen::Vector3d& x = term.point_m;
    const Eigen::Vector3d e = x - inverse * term.fixed_m;
    const double w = term.weight * huber_weight(e.norm(), huber_m);
    Eigen::Matrix3d skew;
    skew << 0, -x.z(), x.y(), x.z(), 0, -x.x(), -x.y(), x.x(), 0;
    Matrix6& hessian = sum.point_hessian;
    hessian.topLeftCorner<3, 3>() += w * Eigen::Matrix3d::Identity();
    hessian.topRightCorner<3, 3>() -= w * skew;
    hessian.bottomLeftCorner<3, 3>() += w * skew;
    hessian.bottomRightCorner<3, 3>() += w * skew.transpose() * skew;
    sum.gradient.head<3>() += w * e;
    sum.gradient.tail<3>() += w * x.cross(e);
    sum.point_squares += w * e.squaredNorm();
    sum.point_weight += w;
  }
}

NormalEquations linearize(const Pose& pose, std::span<const PlaneTerm> planes,
                          std::span<const PointTerm> points, const JointOptions& options) {
  NormalEquations sum;
  add_planes(planes, pose, options.plane_huber_m, sum);
  add_points(points, pose, options.point_huber_m, sum);
  return sum;
}

double root_mean(double squares, double weight) {
  return weight > 0.0 ? std::sqrt(squares / weight) : 0.0;
}

}  // namespace

JointResult optimize_jointly(const Pose& start, std::span<const PlaneTerm> planes,
                             std::span<const PointTerm> points, const JointOptions& options) {
  JointResult result;
  Pose pose = start;
  for (int i = 0; i < options.max_iterations; ++i) {
    const NormalEquations sum = linearize(pose, planes, points, options);
    const Twist step = (sum.plane_hessian + sum.point_hessian).ldlt().solve(-sum.gradient);
    if (!step.allFinite()) return result;
    pose.translation_m += pose.rotation * step.head<3>();
    pose.rotation = (pose.rotation * so3_exp(step.tail<3>())).normalized();
    result.step_m = step.head<3>().norm();
    if (step.norm() < kConverged) break;
  }
  const NormalEquations sum = linearize(pose, planes, points, options);
  result.plane_hessian = sum.plane_hessian;
  result.hessian = sum.plane_hessian + sum.point_hessian;
  result.plane_rms_m = root_mean(sum.plane_squares, sum.plane_weight);
  result.point_rms_m = root_mean(sum.point_squares, sum.point_weight);
  result.T_odom_scan = pose;
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(result.hessian, Eigen::EigenvaluesOnly);
  result.ok =
      pose.translation_m.allFinite() && eigen.eigenvalues()(0) > kSingular * eigen.eigenvalues()(5);
  return result;
}

}  // namespace glint::slam
