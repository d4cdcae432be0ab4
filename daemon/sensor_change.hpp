// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>

#include "driver/core/sensor_info.hpp"

namespace glint::daemon {

/// What differs between two metadata so that scans of one cannot follow those of the other: layout
/// of the packets, geometry or rate. For people, "lidar_mode 512x10 -> 1024x10, ..."; empty when
/// they differ in no more than whose they are.
std::string stream_change(const SensorInfo& from, const SensorInfo& to);

}  // namespace glint::daemon
