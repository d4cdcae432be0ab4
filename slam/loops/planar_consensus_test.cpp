// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/planar_consensus.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace glint::slam {
namespace {

constexpr float kGate_m = 0.5F;

/// Pairs that a turn and a shift explain, the first `good` of them; `mirror` turns y about first.
std::vector<PlanarPair> planar_pairs(double yaw_rad, float mirror, int good, int all) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-25.0F, 25.0F);
  std::normal_distribution<float> noise(0.0F, 0.1F);
  const auto cosine = static_cast<float>(std::cos(yaw_rad));
  const auto sine = static_cast<float>(std::sin(yaw_rad));
  std::vector<PlanarPair> pairs;
  for (int i = 0; i < all; ++i) {
    const Eigen::Vector2f at_m(place(random), place(random));
    const Eigen::Vector2f p(at_m.x(), mirror * at_m.y());
    const Eigen::Vector2f elsewhere_m(place(random), place(random));
    const Eigen::Vector2f turned_m(cosine * p.x() - sine * p.y() + 4.0F,
                                   sine * p.x() + cosine * p.y() - 7.0F);
    const Eigen::Vector2f error_m(noise(random), noise(random));
    pairs.push_back({i < good ? turned_m + error_m : elsewhere_m, at_m});
  }
  return pairs;
}

TEST(PlanarConsensus, FindsAnyTurnAmongPairsMostOfWhichAreWrong) {
  for (int i = 0; i < 12; ++i) {
    const double yaw_rad = -3.0 + 0.5 * i;
    const PlanarConsensus found = find_planar_consensus(planar_pairs(yaw_rad, 1, 15, 40), kGate_m);
    EXPECT_GE(found.inliers, 15);
    EXPECT_LE(found.inliers, 18);
    EXPECT_NEAR(std::remainder(found.yaw_rad - yaw_rad, 2.0 * M_PI), 0.0, 0.01);
    EXPECT_LT((found.translation_m - Eigen::Vector2d(4.0, -7.0)).norm(), 0.1);
  }
}

TEST(PlanarConsensus, AMirrorImageDoesNotFit) {
  for (int i = 0; i < 12; ++i) {
    const auto pairs = planar_pairs(-3.0 + 0.5 * i, -1, 40, 40);
    EXPECT_LT(find_planar_consensus(pairs, kGate_m).inliers, 8);
  }
}

TEST(PlanarConsensus, FindsNothingWhereThereIsNothing) {
  EXPECT_EQ(find_planar_consensus({}, kGate_m).inliers, 0);
  EXPECT_LT(find_planar_consensus(planar_pairs(0.0, 1, 0, 40), kGate_m).inliers, 6);
}

}  // namespace
}  // namespace glint::slam
