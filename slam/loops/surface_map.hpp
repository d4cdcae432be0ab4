// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "slam/loops/voxel_key.hpp"

namespace glint::slam {

/// The surfaces of a few keyframes: the plane of the points in each cube, where they lie on one.
/// Quick to make and to ask, for one registration. Thread-compatible.
class SurfaceMap {
 public:
  struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  };

  /// Room for about so many points is made.
  SurfaceMap(float edge_m, std::size_t points);
  void add(const Eigen::Vector3f& point_m);
  /// The plane whose middle is nearest, of the point's cube and those around it. A cube's plane is
  /// found when it is first asked for and kept: add all points before.
  std::optional<Plane> plane_near(const Eigen::Vector3d& point_m);

 private:
  struct Cube {
    std::uint32_t points = 0;
    bool asked = false;
    bool flat = false;
    Eigen::Vector3f origin_m = Eigen::Vector3f::Zero();  ///< First point: sums are relative to it.
    Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
    Eigen::Matrix3f squares_m2 = Eigen::Matrix3f::Zero();
    Plane plane;
  };

  void find_plane(Cube& cube) const;

  const float edge_m_;
  std::unordered_map<std::uint64_t, Cube> cubes_;
};

}  // namespace glint::slam
