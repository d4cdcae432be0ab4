// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/local_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

INSTANTIATE_TEST_SUITE_P(Neighbours, LocalMaps, testing::Values(3, 5));

}  // namespace
}  // namespace glint::slam
