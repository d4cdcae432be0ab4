// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/scene/blind_axes.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace glint::synth {
namespace {

constexpr double kLeastShare = 0.02;
constexpr double kFacing = 0.5;  // cos 60 degrees

}  // namespace

std::vector<Eigen::Vector3d> blind_axes(std::span<const Eigen::Vector3d> normals) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& normal : normals) scatter += normal * normal.transpose();
  // The trace is the number of unit normals.
  const double count = scatter.trace();
  if (count < 1.0) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  std::vector<Eigen::Vector3d> axes;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = eigen.eigenvectors().col(i);
    double facing = 0.0;
    for (const Eigen::Vector3d& normal : normals) {
      const double share = std::abs(normal.dot(axis));
      if (share > kFacing) facing += share;
    }
    if (facing < kLeastShare * count) axes.push_back(axis);
  }
  return axes;
}

}  // namespace glint::synth
