// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/loop_verifier.hpp"

#include <algorithm>

namespace glint::slam {
namespace {

// Edge of the cubes that planes are looked for in, to that of those which hold one point of each
// keyframe.
constexpr float kCubesPerVoxel = 2.0F;

// What odometry puts into maps of so many keyframes.
constexpr double kMapSigma_m = 0.03;
constexpr double kMapSigma_rad = 0.008;

SurfaceMap surfaces_of(const Place& base, std::span<const Place> around) {
  const std::vector<Eigen::Vector3f> points_m = points_of(around, base.T_odom_sensor.inverse());
  SurfaceMap map(kCubesPerVoxel * base.voxel_m, points_m.size());
  for (const Eigen::Vector3f& point_m : points_m) map.add(point_m);
  return map;
}

// Every n-th, so that at most so many are left.
std::vector<Eigen::Vector3f> some_of(std::span<const Eigen::Vector3f> points_m, std::size_t most) {
  std::vector<Eigen::Vector3f> some_m;
  const std::size_t step = std::max<std::size_t>(1, (points_m.size() + most - 1) / most);
  for (std::size_t i = 0; i < points_m.size(); i += step) some_m.push_back(points_m[i]);
  return some_m;
}

}  // namespace

LoopVerifier::LoopVerifier(LoopVerifierOptions options)
    : options_(options), matcher_(options.match) {}

Consensus LoopVerifier::match(const Place& older, const Place& current, LoopCandidate& candidate) {
  const std::vector<Match>& matches = matcher_.match(older.descriptors, current.descriptors);
  std::vector<PointPair> pairs;
  pairs.reserve(matches.size());
  for (const Match& match : matches) {
    pairs.push_back({older.keypoints_m[static_cast<std::size_t>(match.reference)].cast<double>(),
                     current.keypoints_m[static_cast<std::size_t>(match.current)].cast<double>(),
                     1.0});
  }
  Consensus consensus = find_consensus(pairs, options_.consensus);
  candidate.from = older.id;
  candidate.to = current.id;
  candidate.matches = static_cast<int>(pairs.size());
  candidate.inliers = static_cast<int>(consensus.inliers.size());
  if (candidate.inliers < options_.min_inliers) {
    candidate.reason = "too few keypoints agree";
  } else if (candidate.inliers < options_.min_inlier_share * candidate.matches) {
    candidate.reason = "too small a share of the keypoints agrees";
  } else if (consensus.sectors < options_.min_sectors) {
    candidate.reason = "the keypoints that agree lie to one side";
  }
  return consensus;
}

bool LoopVerifier::registered(const Place& older, std::span<const Place> around,
                              const Place& current, const Consensus& start,
                              LoopCandidate& candidate, LoopEdge& edge) {
  SurfaceMap map = surfaces_of(older, around);
  std::vector<PointTerm> keypoints;
  keypoints.reserve(start.inliers.size());
  for (const PointPair& pair : start.inliers) {
    keypoints.push_back({pair.current_m, pair.reference_m, kKeypointWeight});
  }
  const auto points_m = some_of(current.points_m, options_.registered_points);
  const SurfaceRegistration found =
      register_on_surfaces(map, points_m, keypoints, start.T_reference_current);
  return judge(found, older, current, options_.min_overlap, candidate, edge);
}

bool LoopVerifier::registered_by_shape(const Place& older, std::span<const Place> around,
                                       const Place& current, std::span<const Place> before,
                                       const Pose& T_older_current, LoopCandidate& candidate,
                                       LoopEdge& edge) {
  candidate.from = older.id;
  candidate.to = current.id;
  SurfaceMap map = surfaces_of(older, around);
  const auto points_m =
      some_of(points_of(before, current.T_odom_sensor.inverse()), options_.registered_by_shape);
  SurfaceRegistration found =
      register_on_surfaces(map, points_m, {}, T_older_current, options_.least_aligned_by_shape);
  if (found.ok) {
    // Keyframes sway against one another: how the current one is turned its own points tell best.
    const auto own_m = some_of(current.points_m, options_.registered_points);
    const SurfaceRegistration own = register_on_surfaces(map, own_m, {}, found.T_map_scan);
    if (own.ok) found.T_map_scan.rotation = own.T_map_scan.rotation;
  }
  Twist drift;
  drift.head<3>().setConstant(kMapSigma_m * kMapSigma_m);
  drift.tail<3>().setConstant(kMapSigma_rad * kMapSigma_rad);
  found.covariance += Eigen::Matrix<double, 6, 6>(drift.asDiagonal());
  if (found.ok && found.weak_axes > 0) candidate.reason = "the surfaces leave an axis open";
  return judge(found, older, current, options_.min_overlap_by_shape, candidate, edge);
}

bool LoopVerifier::judge(const SurfaceRegistration& found, const Place& older, const Place& current,
                         double min_overlap, LoopCandidate& candidate, LoopEdge& edge) const {
  candidate.overlap = found.overlap;
  candidate.rms_m = found.rms_m;
  if (!found.ok) {
    candidate.reason = "the surfaces do not fix the motion";
  } else if (found.overlap < min_overlap) {
    candidate.reason = "the surfaces overlap too little";
  } else if (found.rms_m > std::max(options_.max_rms_m,
                                    options_.max_rms_share * static_cast<double>(older.voxel_m))) {
    candidate.reason = "the surfaces lie apart";
  }
  if (!candidate.reason.empty()) return false;
  edge = {older.id, current.id, found.T_map_scan, found.covariance};
  return true;
}

}  // namespace glint::slam
