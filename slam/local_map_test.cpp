// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/local_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

namespace glint::slam {
namespace {

// A floor 1 m below the origin, then a wall 5 m ahead; the number of floor points is written to
// `floor`.
std::vector<Eigen::Vector3f> room(std::size_t& floor) {
  std::vector<Eigen::Vector3f> points;
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) {
      points.emplace_back(0.25F * static_cast<float>(i), 0.25F * static_cast<float>(j), -1.0F);
    }
  }
  floor = points.size();
  for (int i = -20; i <= 20; ++i) {
    for (int j = 0; j <= 12; ++j) {
      points.emplace_back(5.0F, 0.25F * static_cast<float>(i), 0.25F * static_cast<float>(j));
    }
  }
  return points;
}

class LocalMaps : public testing::TestWithParam<int> {
 protected:
  static LocalMapOptions options() {
    LocalMapOptions options;
    options.neighbours = GetParam();
    options.voxel_m = 0.2;
    return options;
  }
  LocalMap map_{options()};
  std::vector<PlaneTerm> terms_;
};

TEST_P(LocalMaps, PointsFindTheirSurfaceAndItsDistance) {
  std::size_t floor = 0;
  const auto points = room(floor);
  map_.add(points, floor, {});
  const std::vector<Eigen::Vector3f> scan = {{1.1F, 0.6F, -0.9F}, {4.8F, 1.1F, 1.1F}};
  map_.associate(scan, 1, {}, terms_);
  ASSERT_EQ(terms_.size(), 2U);
  EXPECT_NEAR(std::abs(terms_[0].normal.z()), 1.0, 1e-6);
  EXPECT_NEAR(std::abs(terms_[0].normal.dot(terms_[0].point_m) - terms_[0].offset_m), 0.1, 1e-6);
  EXPECT_EQ(terms_[0].weight, options().ground_weight);
  EXPECT_NEAR(std::abs(terms_[1].normal.x()), 1.0, 1e-6);
  EXPECT_NEAR(std::abs(terms_[1].normal.dot(terms_[1].point_m) - terms_[1].offset_m), 0.2, 1e-6);
  EXPECT_EQ(terms_[1].weight, 1.0);
}

TEST_P(LocalMaps, PointsInLineGiveNoPlane) {
  std::vector<Eigen::Vector3f> ring;
  for (int i = 0; i < 40; ++i) ring.emplace_back(5.0F, 0.25F * static_cast<float>(i), 0.0F);
  map_.add(ring, 0, {});
  map_.associate(std::vector<Eigen::Vector3f>{{5.1F, 3.0F, 0.0F}}, 0, {}, terms_);
  EXPECT_TRUE(terms_.empty());
}

TEST_P(LocalMaps, GroundIsHeldAgainstGroundOnly) {
  std::size_t floor = 0;
  const auto points = room(floor);
  map_.add(points, floor, {});
  map_.associate(std::vector<Eigen::Vector3f>{{5.0F, 1.1F, 1.5F}}, 1, {}, terms_);
  EXPECT_TRUE(terms_.empty()) << "no ground is near this point of the wall";
}

TEST_P(LocalMaps, WhatIsFarBehindIsLetGo) {
  std::size_t floor = 0;
  const auto points = room(floor);
  map_.add(points, floor, {});
  const std::size_t before = map_.size();
  const Pose far{Eigen::Quaterniond::Identity(), {400.0, 0.0, 0.0}};
  map_.add(points, floor, far);
  EXPECT_EQ(map_.size(), before);
  map_.associate(std::vector<Eigen::Vector3f>{{1.1F, 0.6F, -0.9F}}, 1, {}, terms_);
  EXPECT_TRUE(terms_.empty());
}

TEST_P(LocalMaps, LookingAgainFindsWhatLookingAnewDoes) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> spread(-3.0F, 3.0F);
  std::vector<Eigen::Vector3f> points(2000);
  for (Eigen::Vector3f& point : points)
    point = {spread(random), spread(random), 0.1F * spread(random)};
  map_.add(points, 0, {});
  const std::vector<Eigen::Vector3f> scan(points.begin(), points.begin() + 300);
  for (const double moved_m : {0.0, 0.01, 0.1, 0.5, 3.0}) {
    const Pose there{Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * moved_m, Eigen::Vector3d::UnitZ())),
                     {moved_m, -moved_m, 0.0}};
    std::vector<PlaneTerm> again;
    map_.associate(scan, 0, {}, terms_);
    map_.associate_again(scan, 0, there, again);
    map_.associate(scan, 0, there, terms_);
    ASSERT_EQ(again.size(), terms_.size());
    ASSERT_GT(again.size(), moved_m < 1.0 ? 150U : 0U);
    for (std::size_t i = 0; i < again.size(); ++i) {
      EXPECT_EQ(again[i].point_m, terms_[i].point_m);
      EXPECT_EQ(again[i].normal, terms_[i].normal);
      EXPECT_EQ(again[i].offset_m, terms_[i].offset_m);
    }
  }
}

// Of many noisy measurements the map must not pick those that the noise brought nearest to the
// middles of its cubes.
TEST_P(LocalMaps, AWallSeenOftenStaysWhereItIs) {
  std::mt19937 random(6);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  constexpr float kWall_m = 5.05F;  // in a cube from 5.0 to 5.2 m
  for (int scan = 0; scan < 50; ++scan) {
    std::vector<Eigen::Vector3f> wall;
    for (int i = -40; i <= 40; ++i) {
      for (int j = 0; j <= 10; ++j) {
        wall.emplace_back(kWall_m + noise(random), 0.1F * static_cast<float>(i),
                          0.1F * static_cast<float>(j));
      }
    }
    map_.add(wall, 0, {});
  }
  std::vector<Eigen::Vector3f> seen;
  for (int i = -30; i <= 30; ++i) seen.emplace_back(kWall_m, 0.1F * static_cast<float>(i), 0.5F);
  map_.associate(seen, 0, {}, terms_);
  ASSERT_GT(terms_.size(), 30U);
  double off_m = 0.0;
  for (const PlaneTerm& term : terms_) {
    const Eigen::Vector3d normal =
        term.normal.x() > 0 ? term.normal : Eigen::Vector3d(-term.normal);
    off_m += (normal.dot(term.point_m) - (term.normal.x() > 0 ? 1 : -1) * term.offset_m) /
             static_cast<double>(terms_.size());
  }
  EXPECT_NEAR(off_m, 0.0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Neighbours, LocalMaps, testing::Values(3, 5));

}  // namespace
}  // namespace glint::slam
