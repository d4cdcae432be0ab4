// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/look_alike.hpp"

#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "slam/loops/surface_map.hpp"
#include "slam/loops/voxel_key.hpp"
#include "slam/matching.hpp"

namespace glint::slam {
namespace {

// A keypoint is found within this distance, and as far again as its pixel is wide.
constexpr float kGate_m = 0.1F;
constexpr float kGateShare = 0.01F;
constexpr int kMostBits = 64;
// Edge of the cubes that planes are looked for in, to that of those which hold one point of each
// keyframe: larger where few keyframes must do.
constexpr float kKnownCubesPerVoxel = 2.0F;
constexpr float kKnownCubesOfFew = 4.0F;
constexpr std::size_t kFewKeyframes = 3;
// About.
constexpr std::size_t kPointsOfKeyframe = 2000;
// Far ones are too coarse to be told apart. The gate there is within the cells searched.
constexpr float kFarthestAlike_m = 20.0F;
constexpr float kCell_m = 0.5F;
// A cube is judged with so many keypoints; it contradicts when this share of the usual number of
// them, or fewer, is found, and chance would not have it so.
constexpr float kCube_m = 1.0F;
constexpr int kFewest = 8;
constexpr double kFewFound = 0.25;
constexpr double kChance = 0.001;
// Share of the keypoints that is asked for, the strongest: weak corners come and go.
constexpr double kStrong = 0.5;

struct Cube {
  int keypoints = 0;
  int found = 0;
};

// Probability of at most `found` of `count`, each found with probability `share`.
double chance_of(int count, int found, double share) {
  double sum = 0.0;
  double ways = 1.0;
  for (int i = 0; i <= found; ++i) {
    if (i > 0) ways *= static_cast<double>(count - i + 1) / i;
    sum += ways * std::pow(share, i) * std::pow(1.0 - share, count - i);
  }
  return sum;
}

// The keypoints of a few places by where they are, and their surfaces.
class Known {
 public:
  Known(const Place& base, std::span<const Place> around)
      : surfaces_(
            base.voxel_m * (around.size() < kFewKeyframes ? kKnownCubesOfFew : kKnownCubesPerVoxel),
            kPointsOfKeyframe * around.size()) {
    const Pose T_base_odom = base.T_odom_sensor.inverse();
    for (const Place& place : around) {
      const Pose T_base_place = T_base_odom * place.T_odom_sensor;
      for (std::size_t i = 0; i < place.descriptors.size(); ++i) {
        const Eigen::Vector3f at_m =
            (T_base_place * place.keypoints_m[i].cast<double>()).cast<float>();
        cells_[voxel_key(at_m, kCell_m)].push_back({at_m, &place.descriptors[i]});
      }
      for (const Eigen::Vector3f& point_m : place.points_m) {
        const Eigen::Vector3f at_m = (T_base_place * point_m.cast<double>()).cast<float>();
        surfaces_.add(at_m);
      }
    }
  }

  /// Whether there is a surface there; a car that has left had one that is gone, and one that has
  /// come stands before what was seen.
  [[nodiscard]] bool sees(const Eigen::Vector3f& at_m, float gate_m) {
    const auto plane = surfaces_.plane_near(at_m.cast<double>());
    if (!plane) return false;
    return std::abs(plane->normal.dot(at_m.cast<double>() - plane->middle_m)) <
           static_cast<double>(gate_m);
  }

  [[nodiscard]] bool has(const Eigen::Vector3f& at_m, float gate_m,
                         const Descriptor& descriptor) const {
    const Eigen::Vector3i first = voxel_of(at_m - Eigen::Vector3f::Constant(gate_m), kCell_m);
    const Eigen::Vector3i last = voxel_of(at_m + Eigen::Vector3f::Constant(gate_m), kCell_m);
    Eigen::Vector3i cell;
    for (cell.x() = first.x(); cell.x() <= last.x(); ++cell.x()) {
      for (cell.y() = first.y(); cell.y() <= last.y(); ++cell.y()) {
        for (cell.z() = first.z(); cell.z() <= last.z(); ++cell.z()) {
          const auto found = cells_.find(voxel_key(cell));
          if (found == cells_.end()) continue;
          for (const auto& [point_m, known] : found->second) {
            if ((point_m - at_m).squaredNorm() < gate_m * gate_m &&
                hamming_distance(*known, descriptor) <= kMostBits) {
              return true;
            }
          }
        }
      }
    }
    return false;
  }

 private:
  std::unordered_map<std::uint64_t, std::vector<std::pair<Eigen::Vector3f, const Descriptor*>>>
      cells_;
  SurfaceMap surfaces_;
};

}  // namespace

Comparison compare_places(const Place& known, std::span<const Place> around, const Place& seen,
                          const Pose& T_known_seen) {
  Known index(known, around);
  std::unordered_map<std::uint64_t, Cube> cubes;
  Cube all;
  const auto strong =
      static_cast<std::size_t>(kStrong * static_cast<double>(seen.descriptors.size()));
  for (std::size_t i = 0; i < strong; ++i) {
    const Eigen::Vector3f at_m = (T_known_seen * seen.keypoints_m[i].cast<double>()).cast<float>();
    const float range_m = std::max(at_m.norm(), seen.keypoints_m[i].norm());
    const float gate_m = kGate_m + kGateShare * range_m;
    if (range_m > kFarthestAlike_m || !index.sees(at_m, gate_m)) continue;
    const bool found = index.has(at_m, gate_m, seen.descriptors[i]);
    for (Cube* cube : {&all, &cubes[voxel_key(at_m, kCube_m)]}) {
      ++cube->keypoints;
      cube->found += found ? 1 : 0;
    }
  }
  Comparison comparison;
  if (all.keypoints == 0) return comparison;
  comparison.confirmed = static_cast<double>(all.found) / all.keypoints;
  for (const auto& [key, cube] : cubes) {
    if (cube.keypoints >= kFewest &&
        cube.found <= kFewFound * comparison.confirmed * cube.keypoints &&
        chance_of(cube.keypoints, cube.found, comparison.confirmed) < kChance) {
      ++comparison.contradictions;
    }
  }
  return comparison;
}

}  // namespace glint::slam
