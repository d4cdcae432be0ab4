// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/test_sensor.hpp"

namespace glint::test {

/// The sensor of the daemon's tests: small, RNG19.
SensorInfo room_sensor();

/// The k-th scan of a sensor that drifts through a box-shaped room with patterned walls.
/// Deterministic.
LidarScan room_scan(const SensorInfo& info, int k);

/// Packets of `count` scans of that sensor, frame ids 0, 1, 2, ...
std::vector<Bytes> room_packets(const SensorInfo& info, int count);

}  // namespace glint::test
