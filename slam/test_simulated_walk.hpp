// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <vector>

#include "driver/core/imu_packet.hpp"
#include "driver/core/lidar_scan.hpp"
#include "pcap/synth/simulator.hpp"

namespace glint::test {

/// The simulator's next scan with what the assembler adds to one that came whole; false at the end.
bool next_whole(synth::Simulator& simulator, LidarScan& scan);

/// What an IMU without errors measures on the walk from `from` to `to`, 100 times a second.
std::vector<ImuSample> measure_motion(const synth::Simulator& simulator, SensorTime from,
                                      SensorTime to);

}  // namespace glint::test
