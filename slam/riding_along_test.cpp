// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/riding_along.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace glint::slam {
namespace {

// Three points: of the world, on the vehicle, and one that moves across.
class RidingAlong : public testing::Test {
 protected:
  // Those that are left of the matches, by number.
  std::vector<int> left(const Pose& T_reference_now, double sigma_m) const {
    const std::vector<Eigen::Vector3d> then_m = {
        {5.0, 3.0, 1.0}, {1.0, 0.5, -0.5}, {4.0, 0.0, 0.0}};
    const std::vector<Eigen::Vector3d> now_m = {T_reference_now.inverse() * then_m[0], then_m[1],
                                                then_m[2] + Eigen::Vector3d(0.0, 0.3, 0.0)};
    std::vector<Match> matches = {{0, 0, 10}, {1, 1, 10}, {2, 2, 10}};
    leave_out_riding_along(then_m, {}, now_m, T_reference_now, sigma_m, matches);
    std::vector<int> numbers;
    for (const Match& match : matches) numbers.push_back(match.current);
    return numbers;
  }
};

TEST_F(RidingAlong, WhatMovesWithTheSensorIsLeftOut) {
  const Pose ahead{Eigen::Quaterniond::Identity(), {0.3, 0.0, 0.0}};
  EXPECT_EQ(left(ahead, 0.02), (std::vector{0, 2}));
}

TEST_F(RidingAlong, AllStayWhereTheMotionIsUncertain) {
  const Pose ahead{Eigen::Quaterniond::Identity(), {0.3, 0.0, 0.0}};
  EXPECT_EQ(left(ahead, 0.2), (std::vector{0, 1, 2}));
}

TEST_F(RidingAlong, AllStayWhereTheSensorDoes) {
  EXPECT_EQ(left({}, 0.02), (std::vector{0, 1, 2}));
}

}  // namespace
}  // namespace glint::slam
