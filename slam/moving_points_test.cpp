// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/moving_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "slam/backend.hpp"
#include "slam/store/session_map.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/test_session.hpp"

namespace glint::slam {
namespace {

// What a sensor 1.5 m above the ground sees of a yard 30 m wide, and of a thing 1.6 m wide in it.
Keyframe look(double sensor_x_m, std::optional<Eigen::Vector2d> thing_m) {
  constexpr double kHalf_m = 15.0;
  constexpr double kThingHalf_m = 0.8;
  Keyframe keyframe;
  keyframe.estimate.T_odom_sensor.translation_m = {sensor_x_m, 0.0, 1.5};
  const Eigen::Vector3d from_m = keyframe.estimate.T_odom_sensor.translation_m;
  for (int row = 0; row < 32; ++row) {
    const double altitude = (16 - row) * std::numbers::pi / 180.0;
    for (int column = 0; column < 512; ++column) {
      const double azimuth = 2.0 * std::numbers::pi * column / 512;
      const Eigen::Vector3d ray(std::cos(altitude) * std::cos(azimuth),
                                std::cos(altitude) * std::sin(azimuth), std::sin(altitude));
      double range_m = 1e9;
      if (ray.z() < 0) range_m = std::min(range_m, -from_m.z() / ray.z());
      for (int axis = 0; axis < 2; ++axis) {
        range_m = std::min(range_m, (std::copysign(kHalf_m, ray[axis]) - from_m[axis]) / ray[axis]);
      }
      if (thing_m) {
        // A round thing that stands upright.
        const Eigen::Vector2d to = *thing_m - from_m.head<2>();
        const Eigen::Vector2d along = ray.head<2>().normalized();
        const double ahead_m = to.dot(along);
        const double aside_m = std::abs(to.x() * along.y() - to.y() * along.x());
        if (ahead_m > 0 && aside_m < kThingHalf_m) {
          const double hit_m =
              (ahead_m - std::sqrt(kThingHalf_m * kThingHalf_m - aside_m * aside_m)) /
              std::cos(altitude);
          if (hit_m < range_m && from_m.z() + hit_m * ray.z() < 1.8) range_m = hit_m;
        }
      }
      const Eigen::Vector3f point_m = (range_m * ray).cast<float>();
      keyframe.points.push_back({point_m.x(), point_m.y(), point_m.z(), 0.0F});
    }
  }
  return keyframe;
}

std::size_t on_thing(const Keyframe& keyframe, const std::vector<MapPoint>& points,
                     const Eigen::Vector2d& thing_m) {
  return static_cast<std::size_t>(std::ranges::count_if(points, [&](const MapPoint& point) {
    const Eigen::Vector3d place_m =
        keyframe.estimate.T_odom_sensor * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
    return place_m.z() > 0.1 && (place_m.head<2>() - thing_m).norm() < 0.9;
  }));
}

TEST(MovingPoints, WhatComesIsLeftOutAndWhatStandsIsKept) {
  MovingPoints moving;
  std::size_t came = 0;
  std::size_t came_kept = 0;
  std::size_t all = 0;
  std::size_t kept = 0;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector2d thing_m(6.0, -8.0 + 2.0 * i);
    const Keyframe keyframe = look(0.5 * i, thing_m);
    const std::vector<MapPoint>& standing = moving.standing(keyframe);
    if (i == 0) {
      EXPECT_EQ(standing.size(), keyframe.points.size()) << "nothing is known yet";
      continue;
    }
    came += on_thing(keyframe, keyframe.points, thing_m);
    came_kept += on_thing(keyframe, standing, thing_m);
    all += keyframe.points.size();
    kept += standing.size();
  }
  EXPECT_GT(came, 1000U);
  EXPECT_LT(came_kept, came / 10);
  EXPECT_EQ(all - kept, moving.left_out());
  EXPECT_LT(all - kept - (came - came_kept), all / 200) << "of what stands";
}

TEST(MovingPoints, NothingIsLeftOutWhereAllStands) {
  MovingPoints moving;
  for (int i = 0; i < 8; ++i) moving.standing(look(0.5 * i, Eigen::Vector2d(6.0, 2.0)));
  EXPECT_LT(moving.left_out(), 8U * 32U * 512U / 500U);
}

TEST(MovingPoints, AnotherSegmentKnowsNothingOfTheOneBefore) {
  MovingPoints moving;
  moving.standing(look(0.0, {}));
  Keyframe next = look(0.0, Eigen::Vector2d(6.0, 0.0));
  next.estimate.segment = 1;
  EXPECT_EQ(moving.standing(next).size(), next.points.size());
}

class MovingInSessionTest : public test::InDirectory {};

TEST_F(MovingInSessionTest, WhatComesIsNotStoredAndTheSessionsMapIsThatOfTheBackEnd) {
  SlamConfig config;
  config.map_voxel_m = 0.2;
  config.loops = false;
  Backend backend(config, file_);
  std::size_t came = 0;
  const auto thing_at = [](std::uint64_t id) {
    return Eigen::Vector2d(6.0, -8.0 + 2.0 * static_cast<double>(id));
  };
  for (std::uint64_t id = 0; id < 8; ++id) {
    Keyframe keyframe = look(0.5 * static_cast<double>(id), thing_at(id));
    keyframe.id = id;
    keyframe.estimate.sequence = id;
    keyframe.estimate.stamp.ns = static_cast<std::int64_t>(id) * 500'000'000;
    keyframe.edge_covariance.diagonal().setConstant(1e-6);
    if (id > 0) came += on_thing(keyframe, keyframe.points, thing_at(id));
    backend.process(keyframe);
  }
  backend.finish();
  const SessionReader session(file_);
  EXPECT_EQ(moving_in_session(session), MovingInSession::kRemoved);
  std::size_t stored = 0;
  session.for_each_keyframe([&](SessionKeyframe&& of_session) {
    const Keyframe& keyframe = of_session.keyframe;
    if (keyframe.id > 0) stored += on_thing(keyframe, keyframe.points, thing_at(keyframe.id));
  });
  EXPECT_GT(came, 1000U);
  EXPECT_LT(stored, came / 10);
  // The session keeps points to a centimetre, which takes some to the next voxel.
  const auto count = static_cast<double>(backend.snapshot()->point_count);
  EXPECT_NEAR(static_cast<double>(session_map(session)->point_count), count, 0.02 * count);
}

}  // namespace
}  // namespace glint::slam
