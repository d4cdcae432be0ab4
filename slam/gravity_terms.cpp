// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/gravity_terms.hpp"

namespace glint::slam {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// Beyond so many deviations a term counts less and less.
constexpr double kDoubtfulDeviations = 2.0;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// R^T up + M b - u: of a pose, up and the bias.
class GravityResidual : public ceres::SizedCostFunction<3, 7, 3, 3> {
 public:
  explicit GravityResidual(const FeltGravity& felt) : felt_(felt) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Eigen::Matrix3d R_node_map = pose_of(blocks[0]).rotation.conjugate().toRotationMatrix();
    const Eigen::Vector3d up = R_node_map * Eigen::Map<const Eigen::Vector3d>(blocks[1]);
    const Eigen::Map<const Eigen::Vector3d> bias(blocks[2]);
    Eigen::Map<Eigen::Vector3d> out(residuals);
    out = (up + felt_.bias_share * bias - felt_.up) / felt_.sigma_rad;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 7, Eigen::RowMajor>> j(jacobians[0]);
      j.setZero();
      j.middleCols<3>(3) = cross_matrix(up) / felt_.sigma_rad;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajor3> j(jacobians[1]);
      j = R_node_map / felt_.sigma_rad;
    }
    if (jacobians[2] != nullptr) {
      Eigen::Map<RowMajor3> j(jacobians[2]);
      j = felt_.bias_share / felt_.sigma_rad;
    }
    return true;
  }

 private:
  const FeltGravity& felt_;
};

// The bias is small.
class BiasResidual : public ceres::SizedCostFunction<3, 3> {
 public:
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    for (std::size_t i = 0; i < 3; ++i) residuals[i] = blocks[0][i] / kAccelerometerBias;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<RowMajor3> j(jacobians[0]);
    j.setIdentity();
    j /= kAccelerometerBias;
    return true;
  }
};

}  // namespace

GravityTerms::GravityTerms(std::span<const GravityFactor> factors, std::span<const Pose> poses)
    : factors_(factors), loss_(kDoubtfulDeviations) {
  std::map<std::uint32_t, std::vector<GravityFactor>> groups;
  for (const GravityFactor& factor : factors) groups[factor.group].push_back(factor);
  for (const auto& [group, members] : groups) up_[group] = fit_gravity(members, poses).up;
}

void GravityTerms::add_to(ceres::Problem& problem, std::vector<PoseBlock>& blocks) {
  if (factors_.empty()) return;
  for (auto& [group, up] : up_) problem.AddParameterBlock(up.data(), 3, &sphere_);
  problem.AddResidualBlock(new BiasResidual, nullptr, bias_.data());
  for (const GravityFactor& factor : factors_) {
    problem.AddResidualBlock(new GravityResidual(factor.felt), &loss_, blocks[factor.node].data(),
                             up_.at(factor.group).data(), bias_.data());
  }
}

}  // namespace glint::slam
