// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/voxel_plane_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace glint::slam {
namespace {

using Points = std::vector<Eigen::Vector3f>;

Pose at(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}; }

class VoxelPlaneMapTest : public testing::Test {
 protected:
  // A wall across the x axis, each point off it by noise.
  Points wall(double x_m, double sigma_m, int points = 400) {
    std::normal_distribution<float> noise(0.0F, static_cast<float>(sigma_m));
    std::uniform_real_distribution<float> place(-1.0F, 1.0F);
    Points points_m;
    for (int i = 0; i < points; ++i) {
      points_m.emplace_back(static_cast<float>(x_m) + noise(random_), place(random_),
                            place(random_));
    }
    return points_m;
  }

  std::vector<PlaneTerm> look(VoxelPlaneMap& map, const Points& points_m, std::size_t ground = 0,
                              const Pose& pose = {}) {
    std::vector<PlaneTerm> terms;
    map.associate(points_m, ground, pose, terms);
    return terms;
  }

  std::mt19937 random_{1};
};

TEST_F(VoxelPlaneMapTest, NoiseAveragesOut) {
  VoxelPlaneMap map({});
  for (int scan = 0; scan < 30; ++scan) map.add(wall(2.2, 0.02), 0, {});
  const auto terms = look(map, {{2.2F, 0.1F, 0.1F}, {2.2F, -0.3F, 0.6F}});
  ASSERT_EQ(terms.size(), 2U);
  for (const PlaneTerm& term : terms) {
    EXPECT_NEAR(term.normal.dot(term.point_m) - term.offset_m, 0.0, 0.004);
    EXPECT_GT(std::abs(term.normal.x()), 0.9999);
    EXPECT_GT(term.weight, 0.8);
  }
}

TEST_F(VoxelPlaneMapTest, ASurfaceAtTheVoxelsFacesIsOne) {
  VoxelPlaneMap map({});
  for (int scan = 0; scan < 30; ++scan) map.add(wall(2.0, 0.015), 0, {});
  // Were the noise on either side of the face apart, each would find a plane of its own, 1.2 cm
  // off.
  for (const float side_m : {-0.01F, 0.01F}) {
    const auto terms = look(map, {{2.0F + side_m, 0.1F, 0.1F}});
    ASSERT_EQ(terms.size(), 1U);
    EXPECT_NEAR(std::abs(terms[0].normal.dot(terms[0].point_m) - terms[0].offset_m), 0.01, 0.004);
  }
}

TEST_F(VoxelPlaneMapTest, RoughSurfacesWeighLess) {
  VoxelPlaneMap smooth({});
  VoxelPlaneMap rough({});
  for (int scan = 0; scan < 10; ++scan) {
    smooth.add(wall(2.2, 0.01), 0, {});
    rough.add(wall(2.2, 0.04), 0, {});
  }
  const auto fine = look(smooth, {{2.2F, 0.1F, 0.1F}});
  const auto coarse = look(rough, {{2.2F, 0.1F, 0.1F}});
  ASSERT_EQ(fine.size(), 1U);
  ASSERT_EQ(coarse.size(), 1U);
  EXPECT_NEAR(fine[0].weight, 1.0, 0.01);
  EXPECT_NEAR(coarse[0].weight, 0.25, 0.08) << "0.02 m squared to 0.04 m squared";
}

TEST_F(VoxelPlaneMapTest, PointsInLineAndCloudsGiveNoPlane) {
  VoxelPlaneMap map({});
  Points line_m;
  Points cloud_m;
  std::uniform_real_distribution<float> place(0.0F, 0.45F);
  for (int i = 0; i < 200; ++i) {
    line_m.emplace_back(2.2F, place(random_), 0.2F);
    cloud_m.emplace_back(5.0F + place(random_), place(random_), place(random_));
  }
  map.add(line_m, 0, {});
  map.add(cloud_m, 0, {});
  EXPECT_TRUE(look(map, {{2.2F, 0.2F, 0.2F}, {5.2F, 0.2F, 0.2F}}).empty());
}

TEST_F(VoxelPlaneMapTest, WhereThingsAreFinerSmallerVoxelsTell) {
  VoxelPlaneMap map({});
  // Two boards in one middle-sized voxel.
  for (int scan = 0; scan < 10; ++scan) {
    map.add(wall(2.1, 0.005), 0, {});
    map.add(wall(2.4, 0.005), 0, {});
  }
  for (const float board_m : {2.1F, 2.4F}) {
    const auto terms = look(map, {{board_m, 0.1F, 0.1F}});
    ASSERT_EQ(terms.size(), 1U);
    EXPECT_NEAR(terms[0].normal.dot(terms[0].point_m) - terms[0].offset_m, 0.0, 0.005);
  }
}

TEST_F(VoxelPlaneMapTest, GroundAndTheRestAreApart) {
  VoxelPlaneMap map({.ground_weight = 3.0});
  const Points points_m = wall(2.2, 0.005);
  map.add(points_m, points_m.size(), {});
  EXPECT_TRUE(look(map, {{2.2F, 0.1F, 0.1F}}, 0).empty());
  const auto terms = look(map, {{2.2F, 0.1F, 0.1F}}, 1);
  ASSERT_EQ(terms.size(), 1U);
  EXPECT_NEAR(terms[0].weight, 3.0, 0.01);
}

TEST_F(VoxelPlaneMapTest, WhatWasLeftBehindIsForgottenAndBeginsAnew) {
  VoxelPlaneMap map({.reach_m = 10.0});
  map.add(wall(2.2, 0.005), 0, {});
  map.add({}, 0, at(4.0));
  EXPECT_EQ(look(map, {{2.2F, 0.1F, 0.1F}}).size(), 1U);
  map.add({}, 0, at(-7.0));
  EXPECT_TRUE(look(map, {{2.2F, 0.1F, 0.1F}}).empty());
  // Back there, odometry has drifted: the wall of now is not mixed with that of then.
  map.add(wall(2.3, 0.005), 0, {});
  const auto terms = look(map, {{2.3F, 0.1F, 0.1F}});
  ASSERT_EQ(terms.size(), 1U);
  EXPECT_NEAR(terms[0].normal.dot(terms[0].point_m) - terms[0].offset_m, 0.0, 0.003);
}

TEST_F(VoxelPlaneMapTest, WhoStandsForgetsNothingHoweverLong) {
  VoxelPlaneMap map({.reach_m = 10.0});
  map.add(wall(2.2, 0.005), 0, at(0.0));
  // What it sees meanwhile is something else; its pose jitters by 2 cm.
  for (int i = 0; i < 2000; ++i) map.add({}, 0, at(0.02 * (i % 2)));
  EXPECT_EQ(look(map, {{2.2F, 0.1F, 0.1F}}).size(), 1U);
}

TEST_F(VoxelPlaneMapTest, WhoStaysAboutKeepsAll) {
  VoxelPlaneMap map({.reach_m = 10.0});
  for (int i = 0; i < 100; ++i) map.add(wall(2.2, 0.005), 0, at(0.0));
  for (int i = 0; i < 100; ++i) map.add(wall(2.2 - i % 2, 0.005, 50), 0, at(i % 2));
  EXPECT_EQ(look(map, {{2.2F, 0.1F, 0.1F}}).size(), 1U);
}

TEST_F(VoxelPlaneMapTest, MemoryIsBoundedAndTheLatestStays) {
  VoxelPlaneMap map({.bytes = 100'000, .reach_m = 0.0});
  std::size_t most = 0;
  for (int i = 0; i < 300; ++i) {
    map.add(wall(2.2, 0.005), 0, at(i));
    most = std::max(most, map.size());
  }
  EXPECT_LE(most, 100'000U / 64U) << "a voxel takes more than 64 bytes";
  EXPECT_EQ(look(map, {{2.2F, 0.1F, 0.1F}}, 0, at(299)).size(), 1U);
  EXPECT_TRUE(look(map, {{2.2F, 0.1F, 0.1F}}, 0, at(0)).empty());
}

TEST_F(VoxelPlaneMapTest, ClearForgetsAll) {
  VoxelPlaneMap map({});
  map.add(wall(2.2, 0.005), 0, {});
  EXPECT_GT(map.size(), 0U);
  map.clear();
  EXPECT_EQ(map.size(), 0U);
  EXPECT_TRUE(look(map, {{2.2F, 0.1F, 0.1F}}).empty());
}

}  // namespace
}  // namespace glint::slam
