// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "driver/core/sensor_info.hpp"

namespace glint {

/// The major number of the firmware, 2 of "v2.3.0"; 0 when the metadata does not say.
int firmware_major(const SensorInfo& info);

// What holds for a sensor whose metadata does not say: values of its generation, told by product
// line and firmware. Read from `info`: product_line, firmware, columns_per_frame, beam_azimuth_deg.

/// Distance from the lidar's axis to the beams' origin, mm.
double default_beam_origin_mm(const SensorInfo& info);
/// Row-major transforms, translations in mm.
Eigen::Matrix4d default_lidar_to_sensor(const SensorInfo& info);
Eigen::Matrix4d default_imu_to_sensor(const SensorInfo& info);
/// One shift a beam.
std::vector<int> default_pixel_shifts(const SensorInfo& info);

}  // namespace glint
