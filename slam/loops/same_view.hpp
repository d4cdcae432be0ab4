// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <span>

#include "driver/core/pose.hpp"
#include "slam/keyframe.hpp"

namespace glint::slam {

/// Whether a keyframe nearby, at T_kept_other, shows nothing that `kept` does not show: nearly all
/// of its points lie, by direction and range, where `kept` has points too. Points in either's own
/// sensor frame, m; those of `kept` may be of several views around it. Any thread.
bool shows_the_same(std::span<const MapPoint> kept, std::span<const MapPoint> other,
                    const Pose& T_kept_other);
bool shows_the_same(std::span<const Eigen::Vector3f> kept, std::span<const Eigen::Vector3f> other,
                    const Pose& T_kept_other);

}  // namespace glint::slam
