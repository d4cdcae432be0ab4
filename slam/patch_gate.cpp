// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/patch_gate.hpp"

#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

// So many patches, in so many of eight sectors, are believed rather than keypoints that are off by
// more than this along a weak axis.
constexpr int kFewestPatches = 12;
constexpr int kFewestPatchSectors = 3;
constexpr double kContradicting_m = 0.08;
constexpr double kBelievedChiSquared = 3.84;

}  // namespace

bool agrees_with_motion(const Pose& found, const PosePrior& prior, const WeakAxes& axes) {
  const Eigen::Vector3d off_m =
      found.rotation.conjugate() * (found.translation_m - prior.T_odom_scan.translation_m);
  return std::ranges::all_of(axes, [&](const WeakAxis& weak) {
    if (weak.rotation) return true;
    const Eigen::Vector3d axis = found.rotation.conjugate() * weak.axis;
    const double information = axis.dot(prior.information.topLeftCorner<3, 3>() * axis);
    const double along_m = off_m.dot(axis);
    return along_m * along_m * information < kBelievedChiSquared;
  });
}

bool outvote_keypoints(const PatchVotes& votes) {
  return votes.patches >= kFewestPatches && votes.sectors >= kFewestPatchSectors;
}

void drop_contradicting(const WeakAxes& axes, const Pose& pose, std::vector<PointTerm>& points) {
  std::erase_if(points, [&](const PointTerm& term) {
    const Eigen::Vector3d error_m = pose * term.point_m - term.fixed_m;
    return std::ranges::any_of(axes, [&](const WeakAxis& weak) {
      return !weak.rotation && std::abs(error_m.dot(weak.axis)) > kContradicting_m;
    });
  });
}

void judge_axes(WeakAxes& axes, const PatchVotes& votes, std::span<const PointTerm> points,
                const Pose& T_odom_scan, bool turn_is_measured) {
  for (WeakAxis& axis : axes) {
    const bool told = axis.rotation ? turn_is_measured : outvote_keypoints(votes);
    axis.critical = !told && !carried_by_points(axis, points, T_odom_scan);
  }
}

}  // namespace glint::slam
