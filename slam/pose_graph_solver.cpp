// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/pose_graph_solver.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "slam/gravity_terms.hpp"
#include "slam/pose_block.hpp"

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Jacobian = Eigen::Matrix<double, 6, 7, Eigen::RowMajor>;

// Phi of the last round, and by what it falls in each.
constexpr double kFinalScale = 1.0;
constexpr double kScaleStep = 0.2;
constexpr int kRoundIterations = 12;
constexpr int kFinalIterations = 20;

Twist misfit(const Pose& T_from_to, const Pose& from, const Pose& to) {
  return se3_log(T_from_to.inverse() * (from.inverse() * to));
}

// Inverse right Jacobian of SE(3): log(exp(x) exp(d)) = x + J d. The series of Bernoulli numbers;
// its next term is below 1e-3 up to a misfit of one radian.
Matrix6 inverse_right_jacobian(const Twist& x) {
  const auto skew = [](const Eigen::Vector3d& v) {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
  };
  Matrix6 ad = Matrix6::Zero();
  ad.topLeftCorner<3, 3>() = skew(x.tail<3>());
  ad.topRightCorner<3, 3>() = skew(x.head<3>());
  ad.bottomRightCorner<3, 3>() = ad.topLeftCorner<3, 3>();
  return Matrix6::Identity() + 0.5 * ad + ad * ad / 12.0;
}

// x exp(d). Factors give their derivatives by the six of d at once, as the first columns of those
// by a block's seven numbers, so the manifold's own Jacobian only picks them.
class PoseManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* sum) const override {
    write_block(pose_of(x) * se3_exp(Eigen::Map<const Twist>(delta)), sum);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* difference) const override {
    Eigen::Map<Twist> out(difference);
    out = se3_log(pose_of(x).inverse() * pose_of(y));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Jacobian> out(jacobian);
    out.setIdentity();
    return true;
  }
};

class EdgeFactor : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  explicit EdgeFactor(const GraphEdge& edge) : edge_(edge) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Pose from = pose_of(blocks[0]);
    const Pose to = pose_of(blocks[1]);
    const Twist e = misfit(edge_.T_from_to, from, to);
    Eigen::Map<Twist> out(residuals);
    out = edge_.whitening * e;
    if (jacobians == nullptr) return true;
    const Matrix6 by_to = edge_.whitening * inverse_right_jacobian(e);
    if (jacobians[0] != nullptr) {
      Eigen::Map<Jacobian> j(jacobians[0]);
      j.leftCols<6>() = -by_to * adjoint(to.inverse() * from);
      j.col(6).setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Jacobian> j(jacobians[1]);
      j.leftCols<6>() = by_to;
      j.col(6).setZero();
    }
    return true;
  }

 private:
  const GraphEdge& edge_;
};

// What dynamic covariance scaling comes to: weights s^2 with s = min(1, 2 Phi / (Phi + chi^2)).
class ScalingLoss : public ceres::LossFunction {
 public:
  void set_scale(double scale) { scale_ = scale; }
  void Evaluate(double chi_squared, double rho[3]) const override {
    if (chi_squared <= scale_) {
      rho[0] = chi_squared;
      rho[1] = 1.0;
      rho[2] = 0.0;
      return;
    }
    const double sum = scale_ + chi_squared;
    const double share = 2.0 * scale_ / sum;
    rho[0] = scale_ * (3.0 - 2.0 * share);
    rho[1] = share * share;
    rho[2] = -2.0 * share * share / sum;
  }

 private:
  double scale_ = kFinalScale;
};

// chi^2 of the robust edge that fits worst.
double worst_robust(std::span<const GraphEdge> edges, const std::vector<PoseBlock>& blocks) {
  double worst = 0.0;
  for (const GraphEdge& edge : edges) {
    if (!edge.robust) continue;
    const Twist e =
        misfit(edge.T_from_to, pose_of(blocks[edge.from].data()), pose_of(blocks[edge.to].data()));
    worst = std::max(worst, (edge.whitening * e).squaredNorm());
  }
  return worst;
}

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // One thread, whatever linear algebra library the machine has.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

Matrix6 whitening_of(const Matrix6& covariance) {
  const Eigen::LLT<Matrix6> factor(covariance);
  if (factor.info() != Eigen::Success || !covariance.allFinite()) return Matrix6::Zero();
  const Matrix6 whitening = factor.matrixL().solve(Matrix6::Identity());
  return whitening.allFinite() ? whitening : Matrix6::Zero();
}

double chi_squared(const GraphEdge& edge, std::span<const Pose> poses) {
  return (edge.whitening * misfit(edge.T_from_to, poses[edge.from], poses[edge.to])).squaredNorm();
}

void solve_pose_graph(std::span<Pose> poses, const std::vector<bool>& fixed,
                      std::span<const GraphEdge> edges, std::span<const GravityFactor> gravity) {
  PoseManifold manifold;
  ScalingLoss loss;
  GravityTerms gravity_terms(gravity, poses);
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);

  std::vector<PoseBlock> blocks(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    write_block(poses[i], blocks[i].data());
    problem.AddParameterBlock(blocks[i].data(), 7, &manifold);
    if (fixed[i]) problem.SetParameterBlockConstant(blocks[i].data());
  }
  for (const GraphEdge& edge : edges) {
    problem.AddResidualBlock(new EdgeFactor(edge), edge.robust ? &loss : nullptr,
                             blocks[edge.from].data(), blocks[edge.to].data());
  }

  gravity_terms.add_to(problem, blocks);

  ceres::Solver::Options options = solver_options();
  ceres::Solver::Summary summary;
  double worst = worst_robust(edges, blocks);
  // Where all robust edges count in full the next rounds would find what the last one found.
  for (double scale = worst; worst > kFinalScale && scale > kFinalScale; scale *= kScaleStep) {
    loss.set_scale(scale);
    options.max_num_iterations = kRoundIterations;
    ceres::Solve(options, &problem, &summary);
    worst = worst_robust(edges, blocks);
    scale = std::min(scale, worst);
  }
  loss.set_scale(kFinalScale);
  options.max_num_iterations = kFinalIterations;
  ceres::Solve(options, &problem, &summary);
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = pose_of(blocks[i].data());
}

}  // namespace glint::slam
