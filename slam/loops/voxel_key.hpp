// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace glint::slam {

/// The number of a cube along each axis.
inline Eigen::Vector3i voxel_of(const Eigen::Vector3f& point_m, float edge_m) {
  return (point_m / edge_m).array().floor().cast<int>();
}

/// A cube's three numbers in one word; the cubes of a million a side do not meet.
inline std::uint64_t voxel_key(const Eigen::Vector3i& voxel) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21U) - 1U;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    key = key << 21U | (static_cast<std::uint64_t>(voxel[axis]) & kMask);
  }
  return key;
}

inline std::uint64_t voxel_key(const Eigen::Vector3f& point_m, float edge_m) {
  return voxel_key(voxel_of(point_m, edge_m));
}

}  // namespace glint::slam
