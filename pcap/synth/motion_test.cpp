// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pcap/synth/world.hpp"

namespace glint::synth {
namespace {

class WorldMotion : public testing::TestWithParam<std::string_view> {};

TEST_P(WorldMotion, RestsForASecondFirst) {
  const World world = make_world(GetParam(), 3);
  const Pose start = world.motion.at(0.0);
  for (double t_s = 0.0; t_s < 1.0; t_s += 0.1) {
    EXPECT_EQ(world.motion.at(t_s).translation_m, start.translation_m);
  }
  EXPECT_GT((world.motion.at(4.0).translation_m - start.translation_m).norm(), 1.0);
}

TEST_P(WorldMotion, IsSmooth) {
  const World world = make_world(GetParam(), 4);
  constexpr double kStep_s = 0.01;
  Eigen::Vector3d last_velocity = Eigen::Vector3d::Zero();
  Pose last = world.motion.at(0.0);
  for (double t_s = kStep_s; t_s < 160.0; t_s += kStep_s) {
    const Pose now = world.motion.at(t_s);
    const Eigen::Vector3d velocity = (now.translation_m - last.translation_m) / kStep_s;
    const double turn_rate = so3_log(last.rotation.conjugate() * now.rotation).norm() / kStep_s;
    EXPECT_LT(velocity.norm(), 2.5) << t_s;
    EXPECT_LT((velocity - last_velocity).norm() / kStep_s, 8.0) << t_s;
    EXPECT_LT(turn_rate, 2.5) << t_s;
    last_velocity = velocity;
    last = now;
  }
}

TEST_P(WorldMotion, KeepsAwayFromEverything) {
  const World world = make_world(GetParam(), 5);
  for (double t_s = 0.0; t_s < 150.0; t_s += 0.25) {
    EXPECT_GT(world.scene.distance_to_surface_m(world.motion.at(t_s).translation_m), 0.4) << t_s;
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, WorldMotion, testing::ValuesIn(world_names()),
                         [](const auto& i) { return std::string(i.param); });

}  // namespace
}  // namespace glint::synth
