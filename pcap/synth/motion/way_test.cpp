// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/way.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

constexpr double kBase_m = 0.5;

Route rectangle() {
  return {.points_m = {{0, 0, 0}, {20, 0, 0}, {20, 10, 0}, {0, 10, 0}},
          .closed = true,
          .corner_radius_m = 2.0};
}

int turns_on_the_spot(const Way& way) {
  int count = 0;
  for (const Way::Piece& piece : way.pieces()) count += piece.length_m == 0.0 ? 1 : 0;
  return count;
}

TEST(Way, CornersBecomeArcsOfTheRadius) {
  const Way way(rectangle(), kBase_m);
  EXPECT_NEAR(way.length_m(), 60.0 - 4 * 2 * 2.0 + 2.0 * M_PI * 2.0, 1e-9);
  EXPECT_NEAR(way.turn_rad(), 2.0 * M_PI, 1e-9);
  EXPECT_EQ(turns_on_the_spot(way), 0);
  // Half-way round the corner at (20, 0), from its centre at (18, 2).
  const WayPoint corner = way.at(16.0 + 0.25 * M_PI * 2.0);
  EXPECT_NEAR((corner.position_m - Eigen::Vector3d(18 + M_SQRT2, 2 - M_SQRT2, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR(corner.heading_rad, 0.25 * M_PI, 1e-9);
}

TEST(Way, HeadingIsTheDirectionOfTravelRoundAfterRound) {
  const Way way(rectangle(), kBase_m);
  constexpr double kStep_m = 1e-4;
  for (double m = -20.0; m < 2.5 * way.length_m(); m += 0.037) {
    const Eigen::Vector3d moved = way.at(m + kStep_m).position_m - way.at(m - kStep_m).position_m;
    EXPECT_NEAR(moved.norm(), 2 * kStep_m, 1e-6 * kStep_m) << m;
    const double heading = way.at(m).heading_rad;
    EXPECT_NEAR(moved.x(), 2 * kStep_m * std::cos(heading), 2e-4 * kStep_m) << m;
    EXPECT_NEAR(moved.y(), 2 * kStep_m * std::sin(heading), 2e-4 * kStep_m) << m;
    EXPECT_NEAR(way.at(m + kStep_m).heading_rad, heading, kStep_m) << "jumps at " << m;
    EXPECT_NEAR(way.turning_rad(m) + way.pieces()[0].heading_rad, heading, 1e-9) << m;
  }
}

TEST(Way, OpenRouteLeadsThereAndBack) {
  const Way way(Route{.points_m = {{0, 0, 0}, {10, 0, 0}, {10, 5, 0}}}, kBase_m);
  EXPECT_EQ(turns_on_the_spot(way), 2);
  const double half_m = 0.5 * way.length_m();
  EXPECT_NEAR(half_m, 15.0 - 2.0 + 0.5 * M_PI, 1e-9);
  EXPECT_NEAR((way.at(half_m).position_m - Eigen::Vector3d(10, 5, 0)).norm(), 0.0, 1e-9);
  for (const double m : {1.0, 9.3, 14.0}) {
    const WayPoint there = way.at(m);
    const WayPoint back = way.at(way.length_m() - m);
    EXPECT_NEAR((there.position_m - back.position_m).norm(), 0.0, 1e-9);
    EXPECT_NEAR(std::cos(there.heading_rad - back.heading_rad), -1.0, 1e-9);
  }
}

TEST(Way, ShortLegsLimitTheRadiusAndTooTightCornersAreTurnedOnTheSpot) {
  Route route = rectangle();
  route.corner_radius_m = 100.0;
  const Way wide(route, kBase_m);
  EXPECT_NEAR(wide.length_m(), 2 * 10.0 + 2.0 * M_PI * 5.0, 1e-9) << "half of the shorter leg";

  route.corner_radius_m = 0.0;
  const Way sharp(route, kBase_m);
  EXPECT_NEAR(sharp.length_m(), 60.0, 1e-9);
  EXPECT_EQ(turns_on_the_spot(sharp), 4);
}

TEST(Way, KinksInHeightAreLevelledOverTheBase) {
  const Route ramp{.points_m = {{0, 0, 0}, {10, 0, 0}, {20, 0, 2}, {30, 0, 2}}};
  const Way way(ramp, 2.0);
  EXPECT_NEAR(way.at(5.0).position_m.z(), 0.0, 1e-9);
  EXPECT_GT(way.at(10.0).position_m.z(), 0.01);
  const WayPoint middle = way.at(10.0 + 0.5 * std::hypot(10.0, 2.0));
  EXPECT_NEAR(middle.position_m.z(), 1.0, 1e-9);
  EXPECT_NEAR(middle.slope, 2.0 / std::hypot(10.0, 2.0), 1e-9);
  for (double m = 5.0; m < 25.0; m += 0.1) {
    EXPECT_NEAR((way.at(m + 1e-4).position_m.z() - way.at(m - 1e-4).position_m.z()) / 2e-4,
                way.at(m).slope, 1e-4);
    EXPECT_NEAR(way.at(m + 0.01).slope, way.at(m).slope, 2e-3) << "jumps at " << m;
  }
}

TEST(Way, RouteWithoutWayIsRefused) {
  EXPECT_THROW(Way(Route{}, kBase_m), OptionError);
  EXPECT_THROW(Way(Route{.points_m = {{1, 1, 0}, {1, 1, 0}, {1, 1, 3}}}, kBase_m), OptionError);
}

}  // namespace
}  // namespace glint::synth
