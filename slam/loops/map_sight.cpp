// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/map_sight.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "slam/loops/surface_map.hpp"
#include "slam/loops/surface_registration.hpp"

namespace glint::slam {
namespace {

// Keyframes whose points make the surfaces around a scan, and how far away they may have been
// taken: from farther on they show other rooms.
constexpr std::size_t kPlacesAround = 12;
constexpr double kPlaceReach_m = 15.0;
// Of these so many are asked for keypoints, until one shows enough of the same.
constexpr std::size_t kAskedForKeypoints = 3;
// Keypoints that agree on another place than this are of something that looks alike.
constexpr double kKeypointsOff_m = 1.0;
constexpr double kKeypointsOff_rad = 0.2;
// Edge of the cubes that planes are looked for in, to that of those which hold one point of each
// keyframe.
constexpr float kCubesToVoxel = 2.0F;
constexpr std::size_t kScanPoints = 1000;
// A scan of which less lies on the map, or not as close, sees something else.
constexpr double kLeastOnMap = 0.5;
constexpr double kMostRms_m = 0.09;
constexpr double kMostRmsShare = 0.25;  // Of the points' spacing.

std::vector<Eigen::Vector3f> sampled(std::span<const Eigen::Vector3f> points_m) {
  std::vector<Eigen::Vector3f> out_m;
  const std::size_t step =
      std::max<std::size_t>(1, (points_m.size() + kScanPoints - 1) / kScanPoints);
  for (std::size_t i = 0; i < points_m.size(); i += step) out_m.push_back(points_m[i]);
  return out_m;
}

bool is_near(const Pose& a, const Pose& b) {
  const Pose off = a.inverse() * b;
  return off.translation_m.norm() < kKeypointsOff_m &&
         so3_log(off.rotation).norm() < kKeypointsOff_rad;
}

}  // namespace

std::optional<MapFix> MapSight::fix(PlaceShelf& places, const Place& scan, const Pose& guess) {
  const std::vector<Place> around =
      places.nearest(guess.translation_m, kPlacesAround, kPlaceReach_m);
  if (around.empty()) return std::nullopt;
  // Near the scan, so that floats will do.
  const Pose T_map_base = around.front().T_odom_sensor;
  const Pose T_base_map = T_map_base.inverse();
  const std::vector<Eigen::Vector3f> points_m = points_of(around, T_base_map);
  SurfaceMap surfaces(kCubesToVoxel * around.front().voxel_m, points_m.size());
  for (const Eigen::Vector3f& point_m : points_m) surfaces.add(point_m);

  std::vector<PointTerm> keypoints;
  for (std::size_t i = 0; i < std::min(kAskedForKeypoints, around.size()); ++i) {
    LoopCandidate candidate;
    const Consensus same = verifier_.match(around[i], scan, candidate);
    const Pose T_base_place = T_base_map * around[i].T_odom_sensor;
    if (!candidate.reason.empty() ||
        !is_near(guess, around[i].T_odom_sensor * same.T_reference_current)) {
      continue;
    }
    for (const PointPair& pair : same.inliers) {
      keypoints.push_back({pair.current_m, T_base_place * pair.reference_m, kKeypointWeight});
    }
    break;
  }
  const SurfaceRegistration found =
      register_on_surfaces(surfaces, sampled(scan.points_m), keypoints, T_base_map * guess);
  const double most_rms_m =
      std::max(kMostRms_m, kMostRmsShare * static_cast<double>(around.front().voxel_m));
  if (!found.ok || found.overlap < kLeastOnMap || found.rms_m > most_rms_m) return std::nullopt;
  return MapFix{T_map_base * found.T_map_scan, found.covariance, found.overlap, found.rms_m};
}

}  // namespace glint::slam
