// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/loop_verifier.hpp"

#include <algorithm>

namespace glint::slam {
namespace {

// Edge of the cubes that planes are looked for in, to that of those which hold one point of each
// keyframe.
constexpr float kCubesPerVoxel = 2.0F;

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
  std::size_t points = 0;
  for (const Place& place : around) points += place.points_m.size();
  SurfaceMap map(kCubesPerVoxel * older.voxel_m, points);
  const Pose T_older_odom = older.T_odom_sensor.inverse();
  for (const Place& place : around) {
    const Pose T_older_place = T_older_odom * place.T_odom_sensor;
    const Eigen::Matrix3f rotation = T_older_place.rotation.toRotationMatrix().cast<float>();
    const Eigen::Vector3f translation_m = T_older_place.translation_m.cast<float>();
    for (const Eigen::Vector3f& point_m : place.points_m)
      map.add(rotation * point_m + translation_m);
  }
  std::vector<Eigen::Vector3f> scan_m;
  const std::size_t step = std::max<std::size_t>(
      1, (current.points_m.size() + options_.registered_points - 1) / options_.registered_points);
  for (std::size_t i = 0; i < current.points_m.size(); i += step) {
    scan_m.push_back(current.points_m[i]);
  }
  std::vector<PointTerm> keypoints;
  keypoints.reserve(start.inliers.size());
  for (const PointPair& pair : start.inliers) {
    keypoints.push_back({pair.current_m, pair.reference_m, kKeypointWeight});
  }
  const SurfaceRegistration found =
      register_on_surfaces(map, scan_m, keypoints, start.T_reference_current);
  candidate.overlap = found.overlap;
  candidate.rms_m = found.rms_m;
  if (!found.ok) {
    candidate.reason = "the surfaces do not fix the motion";
  } else if (found.overlap < options_.min_overlap) {
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
