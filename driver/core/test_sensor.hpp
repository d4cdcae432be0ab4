// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::test {

using Bytes = std::vector<std::byte>;

/// A plausible sensor of any profile and size: beams evenly over +-20 degrees, 10 Hz.
SensorInfo make_sensor(LidarProfile profile, int rows, int columns);

/// A complete scan whose every pixel is random over all that its field can hold.
LidarScan random_scan(const SensorInfo& info, std::uint32_t frame_id, std::mt19937& random);

/// Nominal time of a column of the k-th scan of a stream.
SensorTime nominal_time(const SensorInfo& info, std::int64_t scan, int column);

/// Every packet of a scan, in order.
std::vector<Bytes> encode(const SensorInfo& info, const LidarScan& scan);

/// Zeroes some columns as the assembler does where they did not come.
void clear_columns(LidarScan& scan, int begin, int end);

/// Whether pixels, times and status of all columns are equal.
bool same_columns(const LidarScan& a, const LidarScan& b);

}  // namespace glint::test
