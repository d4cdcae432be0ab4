// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// A pose as Ceres holds it: qx qy qz qw x y z. Factors give their derivatives by the six of a
/// right perturbation, as the first columns of those by these seven.
using PoseBlock = std::array<double, 7>;

inline Pose pose_of(const double* block) {
  return {Eigen::Map<const Eigen::Quaterniond>(block),
          Eigen::Map<const Eigen::Vector3d>(block + 4)};
}

inline void write_block(const Pose& pose, double* block) {
  Eigen::Map<Eigen::Quaterniond> rotation(block);
  rotation = pose.rotation;
  Eigen::Map<Eigen::Vector3d> translation_m(block + 4);
  translation_m = pose.translation_m;
}

}  // namespace glint::slam
