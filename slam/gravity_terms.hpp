// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "slam/gravity_factor.hpp"
#include "slam/pose_block.hpp"

namespace glint::slam {

/// What gravity adds to the solver's problem: a robust term for each node that felt it, and the
/// unknowns of GravityFit, which the problem refers to: this has to outlive it.
class GravityTerms {
 public:
  GravityTerms(std::span<const GravityFactor> factors, std::span<const Pose> poses);
  GravityTerms(const GravityTerms&) = delete;
  GravityTerms& operator=(const GravityTerms&) = delete;

  void add_to(ceres::Problem& problem, std::vector<PoseBlock>& blocks);

 private:
  const std::span<const GravityFactor> factors_;
  std::map<std::uint32_t, Eigen::Vector3d> up_;  ///< By group.
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  ceres::SphereManifold<3> sphere_;
  ceres::CauchyLoss loss_;
};

}  // namespace glint::slam
