// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "daemon/config.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::daemon {

/// The sensor with the clock that the configuration says it has: sensor.clock goes before the
/// metadata, sensor.tai_utc_offset_s comes in. Everything that reads stamps follows from there.
SensorInfo with_clock_settings(SensorInfo info, const Config::Sensor& sensor);

}  // namespace glint::daemon
