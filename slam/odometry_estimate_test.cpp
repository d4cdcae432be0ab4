// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/odometry_estimate.hpp"

#include <gtest/gtest.h>

namespace glint::slam {
namespace {

TEST(TrackingStateNames, AreReadBack) {
  using enum TrackingState;
  for (const auto state : {kInit, kTracking, kDegraded, kLost, kLocalizing, kPaused}) {
    EXPECT_EQ(tracking_state_from(to_string(state)), state);
  }
}

TEST(TrackingStateNames, WhatIsNoStateHasNoStatesName) {
  const std::string_view name = to_string(static_cast<TrackingState>(6));
  EXPECT_EQ(name, "UNKNOWN");
  EXPECT_FALSE(tracking_state_from(name));
}

}  // namespace
}  // namespace glint::slam
