// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/window_ba.hpp"

#include <gtest/gtest.h>

namespace glint::slam {
namespace {

// Keypoints 1 m apart, each with a descriptor of its own: a block of 32 bits that are set.
struct Scene {
  explicit Scene(const Pose& T_odom_scan) {
    for (int i = 0; i < 6; ++i) {
      Descriptor descriptor{};
      descriptor[static_cast<std::size_t>(i / 2)] = 0xFFFF'FFFFULL << (i % 2 == 0 ? 0U : 32U);
      features.descriptors.push_back(descriptor);
      features.points_m.push_back(T_odom_scan.inverse() * Eigen::Vector3d(5.0, i, 1.0));
      features.keypoints.emplace_back();
      matches.push_back({i, i, 0});
    }
  }
  Features features;
  std::vector<Match> matches;
};

const Pose kSecond{so3_exp({0.0, 0.0, 0.1}), {0.5, 0.2, 0.0}};

TEST(SlidingWindow, KeypointsMeetThemselvesInEachOlderScan) {
  SlidingWindow window({});
  const Scene first({});
  window.push(first.features, first.matches, {});
  window.push(first.features, first.matches, {});
  const Scene second(kSecond);
  const auto& terms = window.associate(second.features, second.matches, kSecond);
  ASSERT_EQ(terms.size(), 12U);
  for (const PointTerm& term : terms) {
    EXPECT_NEAR((kSecond * term.point_m - term.fixed_m).norm(), 0.0, 1e-9);
    EXPECT_EQ(term.weight, 1.0) << "equal descriptors";
  }
}

TEST(SlidingWindow, WhatIsTooFarOrLooksOtherwiseIsNoPartner) {
  SlidingWindow window({});
  Scene first({});
  first.features.points_m[0].x() += 0.4;  // beyond the gate
  first.features.descriptors[1] = {~0ULL, ~0ULL, ~0ULL, ~0ULL};
  window.push(first.features, first.matches, {});
  const Scene second(kSecond);
  EXPECT_EQ(window.associate(second.features, second.matches, kSecond).size(), 4U);
}

TEST(SlidingWindow, MeansCountEachKeypointOnce) {
  WindowOptions options;
  options.means = true;
  SlidingWindow window(options);
  for (const double off_m : {-0.02, 0.0, 0.05}) {
    Scene seen({});
    seen.features.points_m[0].z() += off_m;
    window.push(seen.features, seen.matches, {});
  }
  const Scene second(kSecond);
  const auto& terms = window.associate(second.features, second.matches, kSecond);
  ASSERT_EQ(terms.size(), 6U);
  EXPECT_NEAR((terms[0].fixed_m - Eigen::Vector3d(5.0, 0.0, 1.01)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(terms[0].weight, 1.5, 1e-9) << "two would be the limit, of endlessly many frames";
}

TEST(SlidingWindow, OnlyMatchedKeypointsTakePart) {
  SlidingWindow window({});
  Scene first({});
  first.matches.resize(3);
  window.push(first.features, first.matches, {});
  const Scene second(kSecond);
  EXPECT_EQ(window.associate(second.features, second.matches, kSecond).size(), 3U);
}

TEST(SlidingWindow, HoldsTheLastFramesOnly) {
  WindowOptions options;
  options.frames = 4;
  SlidingWindow window(options);
  const Scene scene({});
  for (int i = 0; i < 9; ++i) window.push(scene.features, scene.matches, {});
  EXPECT_EQ(window.size(), 4U);
  EXPECT_EQ(window.associate(scene.features, scene.matches, {}).size(), 24U);
}

}  // namespace
}  // namespace glint::slam
