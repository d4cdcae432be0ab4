// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/clock_settings.hpp"

#include <utility>

namespace glint::daemon {

SensorInfo with_clock_settings(SensorInfo info, const Config::Sensor& sensor) {
  // "auto" is the name of no source.
  info.clock = parse_clock_source(sensor.clock).value_or(info.clock);
  info.tai_utc_offset_s = sensor.tai_utc_offset_s;
  return info;
}

}  // namespace glint::daemon
