// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/ground.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace glint::slam {
namespace {

constexpr double kHeight_m = 0.9;

/// Floor at kHeight_m below the sensor, tilted about y; a table, and walls.
std::vector<Eigen::Vector3f> room(double tilt_rad, bool with_floor = true, bool with_table = true) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-8.0F, 8.0F);
  std::normal_distribution<float> noise(0.0F, 0.01F);
  std::vector<Eigen::Vector3f> points;
  const auto slope = static_cast<float>(std::tan(tilt_rad));
  for (int i = 0; i < 400; ++i) {
    const float x = place(random);
    const float y = place(random);
    const auto floor = static_cast<float>(-kHeight_m) + slope * x + noise(random);
    if (with_floor) points.emplace_back(x, y, floor);
    if (with_table && i < 100)
      points.emplace_back(0.1F * x + 3.0F, 0.1F * y, -0.2F + noise(random));
    points.emplace_back(8.0F + noise(random), y, 0.3F * place(random));
    points.emplace_back(x, 8.0F + noise(random), 0.3F * place(random));
  }
  return points;
}

TEST(GroundFinder, FindsFloorAndHeightByItself) {
  GroundFinder finder({});
  auto points = room(0.0);
  std::size_t count = 0;
  const auto plane = finder.find(points, Eigen::Vector3d::UnitZ(), &count);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->height_m, kHeight_m, 0.01);
  EXPECT_GT(plane->normal.z(), 0.9999);
  EXPECT_GE(count, 390U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool low = points[i].z() < -0.8F;
    if (i < count) {
      EXPECT_LT(points[i].z(), -0.8F);
    } else if (low) {
      EXPECT_GT(std::abs(points[i].z() + kHeight_m), 0.03);
    }
  }
}

TEST(GroundFinder, ASlopeIsGroundUpToItsTilt) {
  for (const double tilt_rad : {0.1, 0.2}) {
    GroundFinder finder({});
    auto points = room(tilt_rad);
    std::size_t count = 0;
    const auto plane = finder.find(points, Eigen::Vector3d::UnitZ(), &count);
    ASSERT_TRUE(plane) << tilt_rad;
    EXPECT_NEAR(std::acos(plane->normal.z()), tilt_rad, 0.01);
  }
}

TEST(GroundFinder, WithoutAFloorThereIsNone) {
  GroundOptions options;
  options.sensor_height_m = kHeight_m;
  GroundFinder finder(options);
  auto points = room(0.0, false);
  std::size_t count = 1;
  EXPECT_FALSE(finder.find(points, Eigen::Vector3d::UnitZ(), &count));
  EXPECT_EQ(count, 0U);
}

TEST(GroundFinder, AKnownHeightPassesOverATable) {
  GroundOptions options;
  options.sensor_height_m = kHeight_m;
  GroundFinder finder(options);
  auto points = room(0.0);
  std::size_t count = 0;
  const auto plane = finder.find(points, Eigen::Vector3d::UnitZ(), &count);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->height_m, kHeight_m, 0.01);
}

TEST(GroundFinder, TheLowestOfWallsThatGoOnAboveIsNoGround) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-8.0F, 8.0F);
  std::uniform_real_distribution<float> height(-0.24F, 2.0F);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 2000; ++i) {
    points.emplace_back(8.0F, place(random), height(random));
    points.emplace_back(place(random), 8.0F, height(random));
  }
  GroundFinder finder({});
  std::size_t count = 1;
  EXPECT_FALSE(finder.find(points, Eigen::Vector3d::UnitZ(), &count));
}

TEST(GroundFinder, AFalseHeightIsLetGoOf) {
  constexpr int kSeconds = 4;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-1.0F, 1.0F);
  std::vector<Eigen::Vector3f> table;
  for (int i = 0; i < 200; ++i) table.emplace_back(place(random), place(random), -0.22F);
  GroundFinder finder({});
  std::size_t count = 0;
  const auto on_table = finder.find(table, Eigen::Vector3d::UnitZ(), &count);
  ASSERT_TRUE(on_table);
  EXPECT_NEAR(on_table->height_m, 0.22, 0.01);
  std::optional<GroundPlane> plane;
  for (int i = 0; i < 10 * kSeconds; ++i) {
    auto points = room(0.0, true, false);
    plane = finder.find(points, Eigen::Vector3d::UnitZ(), &count);
  }
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->height_m, kHeight_m, 0.01);
}

}  // namespace
}  // namespace glint::slam
