// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <vector>

#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/xyz_lut.hpp"
#include "slam/keyframe.hpp"
#include "slam/scan_images.hpp"

namespace glint::slam {

/// The points of every `column_step`-th column of a scan, in the frame to which `T_end_column`
/// takes those measured in a column.
std::vector<MapPoint> keyframe_points(const SensorInfo& info, const XyzLut& lut,
                                      const ScanImages& images, int column_step,
                                      const std::function<Pose(int column)>& T_end_column);

}  // namespace glint::slam
