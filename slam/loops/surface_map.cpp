// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/surface_map.hpp"

#include <Eigen/Eigenvalues>

namespace glint::slam {
namespace {

constexpr std::uint32_t kFewestPoints = 6;
// Deviation of the points from their plane, at most.
constexpr float kThickness_m = 0.06F;
// Points along a line fit any plane through it: the lesser extent must be this share of the edge.
constexpr float kLeastSurfaceSpread = 0.08F;

}  // namespace

SurfaceMap::SurfaceMap(float edge_m, std::size_t points) : edge_m_(edge_m) {
  cubes_.reserve(points / 4);
}

void SurfaceMap::add(const Eigen::Vector3f& point_m) {
  Cube& cube = cubes_[voxel_key(point_m, edge_m_)];
  if (cube.points++ == 0) cube.origin_m = point_m;
  const Eigen::Vector3f d = point_m - cube.origin_m;
  cube.sum_m += d;
  cube.squares_m2 += d * d.transpose();
}

std::optional<SurfaceMap::Plane> SurfaceMap::plane_near(const Eigen::Vector3d& point_m) {
  const Eigen::Vector3i home = voxel_of(point_m.cast<float>(), edge_m_);
  const Plane* best = nullptr;
  double least_m2 = 0.0;
  Eigen::Vector3i offset;
  for (offset.x() = -1; offset.x() <= 1; ++offset.x()) {
    for (offset.y() = -1; offset.y() <= 1; ++offset.y()) {
      for (offset.z() = -1; offset.z() <= 1; ++offset.z()) {
        const auto found = cubes_.find(voxel_key(home + offset));
        if (found == cubes_.end()) continue;
        Cube& cube = found->second;
        if (!cube.asked) find_plane(cube);
        if (!cube.flat) continue;
        const double distance_m2 = (cube.plane.middle_m - point_m).squaredNorm();
        if (best != nullptr && distance_m2 >= least_m2) continue;
        best = &cube.plane;
        least_m2 = distance_m2;
      }
    }
  }
  if (best == nullptr) return std::nullopt;
  return *best;
}

void SurfaceMap::find_plane(Cube& cube) const {
  cube.asked = true;
  if (cube.points < kFewestPoints) return;
  const auto n = static_cast<float>(cube.points);
  const Eigen::Vector3f mean_m = cube.sum_m / n;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
  eigen.computeDirect(cube.squares_m2 / n - mean_m * mean_m.transpose());
  const float least_extent_m = kLeastSurfaceSpread * edge_m_;
  cube.flat = eigen.eigenvalues()(0) < kThickness_m * kThickness_m &&
              eigen.eigenvalues()(1) > least_extent_m * least_extent_m;
  cube.plane.normal = eigen.eigenvectors().col(0).cast<double>().normalized();
  cube.plane.middle_m = (cube.origin_m + mean_m).cast<double>();
}

}  // namespace glint::slam
