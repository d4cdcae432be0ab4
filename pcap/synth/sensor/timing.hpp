// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

#include "driver/core/sensor_info.hpp"
#include "driver/core/time.hpp"

namespace glint::synth {

/// When things happen: a motor that does not run quite evenly, and a clock that is off by some
/// parts per million and drifts while the sensor warms up. True time counts in seconds from the
/// first column. Immutable; thread-safe.
class Timing {
 public:
  Timing(const SensorInfo& info, std::uint64_t seed);

  /// True time of a column, counted from the first of the run.
  [[nodiscard]] double column_s(std::int64_t column) const;
  /// What the sensor's clock shows at a true time, and the true time at which it shows that.
  [[nodiscard]] SensorTime clock_at(double true_s) const;
  [[nodiscard]] double true_s(SensorTime time) const;
  /// Parts by which the clock runs too fast at a true time, rate error 1e-6 = 1 ppm.
  [[nodiscard]] double clock_rate_error(double true_s) const;

 private:
  const double period_s_;
  const int columns_;
  SensorTime start_;
  double offset_ppm_;
  double warm_up_ppm_;
};

}  // namespace glint::synth
