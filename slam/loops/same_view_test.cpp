// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/same_view.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace glint::slam {
namespace {

/// A round room, and a pillar where there is one, as seen from `x_m` off its middle.
std::vector<MapPoint> room(double radius_m, double x_m = 0.0, bool pillar = false) {
  std::vector<MapPoint> points;
  for (int i = 0; i < 720; ++i) {
    const double angle = i * M_PI / 360.0;
    const double range_m = pillar && i < 100 ? 2.0 : radius_m;
    for (int ring = -8; ring <= 8; ++ring) {
      points.push_back({static_cast<float>(range_m * std::cos(angle) - x_m),
                        static_cast<float>(range_m * std::sin(angle)),
                        static_cast<float>(0.1 * ring), 50.0F});
    }
  }
  return points;
}

Pose at_x(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}; }

TEST(SameView, TheSameRoomFromBesideIsTheSame) {
  EXPECT_TRUE(shows_the_same(room(8.0), room(8.0), {}));
  EXPECT_TRUE(shows_the_same(room(8.0), room(8.0, 0.4), at_x(0.4)));
}

TEST(SameView, WhatStandsThereNowIsNew) {
  EXPECT_FALSE(shows_the_same(room(8.0), room(8.0, 0.4, true), at_x(0.4)));
  EXPECT_FALSE(shows_the_same(room(8.0), room(5.0), {}));
}

TEST(SameView, WhatWasNeverSeenIsNew) {
  EXPECT_FALSE(shows_the_same({}, room(8.0), {}));
  EXPECT_TRUE(shows_the_same(room(8.0), {}, {})) << "nothing is nothing new";
}

}  // namespace
}  // namespace glint::slam
