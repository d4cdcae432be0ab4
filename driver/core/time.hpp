// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <compare>
#include <cstdint>

namespace glint {

/// A point in time of one clock, in nanoseconds of that clock. Points of different clocks neither
/// compare nor subtract; only a clock model may turn one into the other.
template <class Clock>
struct TimePoint {
  std::int64_t ns = 0;

  friend constexpr auto operator<=>(TimePoint, TimePoint) = default;
  /// Difference of two times of one clock, in nanoseconds (signed).
  friend constexpr std::int64_t operator-(TimePoint a, TimePoint b) { return a.ns - b.ns; }
  friend constexpr TimePoint operator+(TimePoint a, std::int64_t delta_ns) {
    return {a.ns + delta_ns};
  }
};

/// Time as the sensor stamps its columns; epoch and rate are the sensor's own.
using SensorTime = TimePoint<struct SensorClockTag>;
/// Time of arrival on this machine: CLOCK_REALTIME when live, the capture's record time in replay.
using HostTime = TimePoint<struct HostClockTag>;

constexpr double kSecondsPerNs = 1e-9;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;

}  // namespace glint
