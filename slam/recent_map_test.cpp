// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/recent_map.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace glint::slam {
namespace {

constexpr double kReach_m = 10.0;

// A patch of floor about the sensor, which goes from place to place.
void add_floor(RecentMap& map, double x_m) {
  std::vector<Eigen::Vector3f> points_m;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      points_m.emplace_back(0.5F * static_cast<float>(i), 0.5F * static_cast<float>(j), -1.0F);
    }
  }
  map.add(points_m, 0, {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}});
}

bool knows_floor_at(RecentMap& map, double x_m) {
  std::vector<PlaneTerm> terms;
  const std::vector<Eigen::Vector3f> below = {{0.0F, 0.0F, -1.0F}};
  map.associate(below, 0, {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}, terms);
  return !terms.empty();
}

TEST(RecentMap, WhatWasLeftBehindTwiceTheReachIsForgotten) {
  RecentMap map({}, kReach_m);
  for (int x_m = 0; x_m <= 15; ++x_m) add_floor(map, x_m);
  EXPECT_TRUE(knows_floor_at(map, 0.0)) << "the second map is young";
  for (int x_m = 16; x_m <= 24; ++x_m) add_floor(map, x_m);
  EXPECT_FALSE(knows_floor_at(map, 0.0));
  EXPECT_TRUE(knows_floor_at(map, 14.0)) << "what was seen since the second one began";
  EXPECT_TRUE(knows_floor_at(map, 24.0));
}

TEST(RecentMap, WhoStaysAboutKeepsAll) {
  RecentMap map({}, kReach_m);
  for (int round = 0; round < 20; ++round) {
    for (int x_m = 0; x_m <= 9; ++x_m) add_floor(map, round % 2 == 0 ? x_m : 9 - x_m);
  }
  EXPECT_TRUE(knows_floor_at(map, 0.0));
  EXPECT_TRUE(knows_floor_at(map, 9.0));
}

TEST(RecentMap, WithoutAReachNothingIsForgotten) {
  RecentMap map({}, 0.0);
  for (int x_m = 0; x_m <= 40; ++x_m) add_floor(map, x_m);
  EXPECT_TRUE(knows_floor_at(map, 0.0));
  map.clear();
  EXPECT_FALSE(knows_floor_at(map, 40.0));
}

}  // namespace
}  // namespace glint::slam
