// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::test {

/// Half the edges of a room around the origin, m.
inline const Eigen::Vector3d kRoomHalf_m{6.0, 4.0, 1.5};

/// A sensor with these beams, top first, 512 columns at 10 Hz; its rows are staggered by turns.
SensorInfo room_sensor(std::vector<double> altitude_deg);
/// 32 beams from +35 to -35 degrees.
SensorInfo room_sensor();

/// What the sensor measures in the room without noise, standing still at T_room_sensor. `time` is
/// that of the first column.
LidarScan scan_room(const SensorInfo& info, const Pose& T_room_sensor, SensorTime time = {0});

/// How far a point is from the nearest wall, floor or ceiling, m.
double distance_from_room(const Eigen::Vector3d& point_m);
/// How far it is from the nearest of the edges where two of them meet.
double distance_from_edges(const Eigen::Vector3d& point_m);

}  // namespace glint::test
