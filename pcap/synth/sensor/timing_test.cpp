// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor/timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pcap/synth/sensor/sensor_options.hpp"

namespace glint::synth {
namespace {

class TimingTest : public testing::Test {
 protected:
  const SensorInfo info_ = make_sensor({}, 4);
  const Timing timing_{info_, 4};
};

TEST_F(TimingTest, TheMotorRunsUnevenlyAboutItsRate) {
  const double nominal_s = 1.0 / (info_.scan_rate_hz * info_.columns_per_frame);
  double shortest_s = 1.0;
  double longest_s = 0.0;
  for (int column = 0; column < 30 * info_.columns_per_frame; ++column) {
    const double step_s = timing_.column_s(column + 1) - timing_.column_s(column);
    shortest_s = std::min(shortest_s, step_s);
    longest_s = std::max(longest_s, step_s);
  }
  EXPECT_NEAR(shortest_s / nominal_s, 0.995, 0.001);
  EXPECT_NEAR(longest_s / nominal_s, 1.005, 0.001);
  EXPECT_NEAR(timing_.column_s(600 * info_.columns_per_frame), 60.0, 0.001);
}

TEST_F(TimingTest, TheClockDriftsWhileItWarmsUpAndIsUndoneExactly) {
  const auto error_s = [&](double t_s) {
    return static_cast<double>(timing_.clock_at(t_s) - timing_.clock_at(0.0)) * kSecondsPerNs - t_s;
  };
  const double cold = error_s(10.0) / 10.0;
  const double warm = (error_s(7200.0) - error_s(7190.0)) / 10.0;
  EXPECT_LT(std::abs(cold), 60e-6);
  EXPECT_LT(std::abs(warm), 60e-6);
  EXPECT_GT(std::abs(cold - warm), 0.05e-6);
  for (const double t_s : {0.0, 0.123, 59.9, 3600.5}) {
    EXPECT_NEAR(timing_.true_s(timing_.clock_at(t_s)), t_s, 2e-9);
  }
}

}  // namespace
}  // namespace glint::synth
