// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/degeneracy.hpp"
#include "slam/joint_optimizer.hpp"
#include "slam/joint_terms.hpp"
#include "slam/patch_tracker.hpp"

namespace glint::slam {

/// Whether the pose that patches found is within what the motion so far leaves open along each weak
/// axis (chi^2, 95 %). Lines that run along such an axis look everywhere as if the sensor stood:
/// what contradicts the motion is not to be believed. Turns and the other axes are not looked at.
/// `found` and `prior` in the odometry frame, `prior.information` in 1/m^2. Pure.
bool agrees_with_motion(const Pose& found, const PosePrior& prior, const WeakAxes& axes);

/// Whether patches tell of a weak axis, and are believed rather than keypoints: enough of them look
/// as they did, all around. Pure.
bool outvote_keypoints(const PatchVotes& votes);

/// Takes out the keypoints that contradict patches along a weak axis, where these are believed:
/// those at the ends of what runs along it go with the sensor. `pose`: where the patches place the
/// scan in the odometry frame.
void drop_contradicting(const WeakAxes& axes, const Pose& pose, std::vector<PointTerm>& points);

/// Makes critical what nothing tells of: an axis along which neither patches nor keypoints carry
/// the pose, one about which neither keypoints do nor a gyroscope measured. `points` at the
/// solution T_odom_scan.
void judge_axes(WeakAxes& axes, const PatchVotes& votes, std::span<const PointTerm> points,
                const Pose& T_odom_scan, bool turn_is_measured);

}  // namespace glint::slam
