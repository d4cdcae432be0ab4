// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/keyframe_selector.hpp"

#include <gtest/gtest.h>

#include <random>

namespace glint::slam {
namespace {

OdometryEstimate estimate_at(std::int64_t scan, const Eigen::Vector3d& at_m, double yaw_rad) {
  OdometryEstimate estimate;
  estimate.stamp.ns = scan * 100'000'000;
  estimate.T_odom_sensor = {so3_exp({0.0, 0.0, yaw_rad}), at_m};
  estimate.matches = 10;  // A poor scene.
  return estimate;
}

TEST(KeyframeSelector, AnHourAtRestMakesOneKeyframe) {
  KeyframeSelector selector{SlamConfig{}};
  std::mt19937 random(3);
  std::normal_distribution<double> jitter(0.0, 0.01);
  int keyframes = 0;
  for (std::int64_t scan = 0; scan < 36'000; ++scan) {
    const Eigen::Vector3d at_m(jitter(random), jitter(random), jitter(random));
    keyframes += selector.select(estimate_at(scan, at_m, 0.2 * jitter(random))) ? 1 : 0;
  }
  EXPECT_EQ(keyframes, 1);
}

TEST(KeyframeSelector, AMovingSensorMakesOneEachHalfMetre) {
  SlamConfig config;
  config.keyframe_min_matches = 0;
  KeyframeSelector selector{config};
  int keyframes = 0;
  for (std::int64_t scan = 0; scan < 1000; ++scan) {
    const Eigen::Vector3d at_m(0.1 * static_cast<double>(scan), 0.0, 0.0);
    keyframes += selector.select(estimate_at(scan, at_m, 0.0)) ? 1 : 0;
  }
  EXPECT_NEAR(keyframes, 180, 21) << "more than half a metre: five or six scans of 0.1 m";
}

}  // namespace
}  // namespace glint::slam
