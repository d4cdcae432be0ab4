// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>

#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/xyz_lut.hpp"
#include "slam/scan_images.hpp"

namespace glint::test {

/// Brightness of the wall, 0 to 255, by the way along the tunnel and the angle about its axis.
using Paint = std::function<double(double x_m, double angle_rad)>;

/// A ring each 3 m: no corner anywhere.
double rings(double x_m, double angle_rad);

/// Range and brightness as seen in a round tunnel along x of 3 m radius; nothing beyond 60 m.
void see_tunnel(const SensorInfo& info, const XyzLut& lut, const Pose& T_tunnel_sensor,
                const Paint& paint, slam::ScanImages& images);

}  // namespace glint::test
