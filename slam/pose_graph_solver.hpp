// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/gravity_factor.hpp"

namespace glint::slam {

/// A measured relative pose between two nodes, numbered from 0.
struct GraphEdge {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose T_from_to;
  /// W with W^T W the information of T_from_to: right perturbation, x y z rx ry rz, 1/m and 1/rad.
  Eigen::Matrix<double, 6, 6> whitening = Eigen::Matrix<double, 6, 6>::Identity();
  /// May be wrong: it counts less the less it fits.
  bool robust = false;
};

/// W of GraphEdge::whitening for a covariance; all zero if that is none (not positive definite).
Eigen::Matrix<double, 6, 6> whitening_of(const Eigen::Matrix<double, 6, 6>& covariance);

/// The squared length of the whitened misfit log(T_from_to^-1 T_map_from^-1 T_map_to), 6 degrees of
/// freedom.
double chi_squared(const GraphEdge& edge, std::span<const Pose> poses);
/// 95 % of right edges stay below.
constexpr double kLargestChiSquared = 12.6;

/// Moves the poses that are not fixed to the least sum of squared misfits. Robust edges are scaled
/// dynamically [Agarwal 2013, "Robust map optimization using dynamic covariance scaling", eq. 15]
/// with Phi falling to 1 from where all of them count in full, so that a far-off but right edge is
/// not given up for its distance [Yang 2020, "Graduated non-convexity"]. What nodes felt of gravity
/// holds their roll and pitch; each group's up and the accelerometer's bias are unknowns, too.
/// Deterministic; one thread.
void solve_pose_graph(std::span<Pose> poses, const std::vector<bool>& fixed,
                      std::span<const GraphEdge> edges,
                      std::span<const GravityFactor> gravity = {});

}  // namespace glint::slam
