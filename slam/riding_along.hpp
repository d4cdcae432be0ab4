// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/matching.hpp"

namespace glint::slam {

/// Takes out the matches of keypoints that stay where they are in the scan although the sensor
/// moved for certain: they are on what carries it, or of the image's own pattern, which is all that
/// a bare tunnel shows. `then_m`, `now_m`: the points of the reference's keypoints, as these
/// were seen, and of the current scan's. `T_reference_now` is foretold, to `sigma_m`. Pure.
void leave_out_riding_along(std::span<const Eigen::Vector3d> then_m, const Pose& T_reference_then,
                            std::span<const Eigen::Vector3d> now_m, const Pose& T_reference_now,
                            double sigma_m, std::vector<Match>& matches);

}  // namespace glint::slam
