// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/protocol_place.hpp"

#include <gtest/gtest.h>

namespace glint::daemon {
namespace {

const Pose kMount{so3_exp({0.0, 0.0, 0.5}), {0.2, 0.0, 0.4}};

std::string refused_field(const Json& params) {
  try {
    parse_place_guess(params, kMount);
  } catch (const RpcError& error) {
    return error.to_json()["data"].value("field", "");
  }
  return "none";
}

TEST(PlaceGuessTest, APositionAloneLeavesTheHeadingOpen) {
  const auto guess = parse_place_guess({{"p_m", {1, 2.5, -0.5}}}, kMount);
  EXPECT_EQ(guess.T_map_sensor.translation_m, Eigen::Vector3d(1, 2.5, -0.5));
  EXPECT_FALSE(guess.knows_heading);
  EXPECT_EQ(guess.sigma_m, 3.0);
}

TEST(PlaceGuessTest, ThePoseMayBeToldInTwoWaysAndOfTheRobot) {
  const auto a = parse_place_guess(
      {{"p_m", {1, 2, 3}}, {"q_xyzw", {0, 0, 0.6, 0.8}}, {"sigma_m", 0.5}}, kMount);
  const auto b = parse_place_guess({{"T", {1, 2, 3, 0, 0, 0.6, 0.8}}, {"child", "base"}}, kMount);
  EXPECT_TRUE(a.knows_heading);
  EXPECT_EQ(a.sigma_m, 0.5);
  EXPECT_TRUE(b.knows_heading);
  const Pose expected = a.T_map_sensor * kMount;
  EXPECT_TRUE(b.T_map_sensor.translation_m.isApprox(expected.translation_m, 1e-12));
  EXPECT_TRUE(b.T_map_sensor.rotation.isApprox(expected.rotation, 1e-12));
}

TEST(PlaceGuessTest, WhatIsNoPoseIsRefusedByName) {
  EXPECT_EQ(refused_field(Json::object()), "p_m");
  EXPECT_EQ(refused_field({{"p_m", {1, 2}}}), "p_m");
  EXPECT_EQ(refused_field({{"p_m", {1, 2, "x"}}}), "p_m");
  EXPECT_EQ(refused_field({{"p_m", {1, 2, 1e9}}}), "p_m");
  EXPECT_EQ(refused_field({{"p_m", {1, 2, 3}}, {"q_xyzw", {0, 0, 0, 2}}}), "q_xyzw");
  EXPECT_EQ(refused_field({{"T", {1, 2, 3, 0, 0, 0, 0}}}), "T");
  EXPECT_EQ(refused_field({{"p_m", {1, 2, 3}}, {"sigma_m", -1}}), "sigma_m");
  EXPECT_EQ(refused_field({{"p_m", {1, 2, 3}}, {"child", "wheel"}}), "child");
}

}  // namespace
}  // namespace glint::daemon
