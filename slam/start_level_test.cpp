// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/start_level.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

constexpr double kMotion_s = 0.1;
const Eigen::Vector3d kTiltedGravity_mps2(0.98, -0.3, -9.75);  // Odometry began tilted.

/// A body that walks along x with a gait of 1.3 Hz, as it turns slowly.
struct Walker {
  double speed_mps = 1.2;

  [[nodiscard]] double x_m(double t_s) const {
    return speed_mps * t_s - 0.15 / (2.0 * M_PI * 1.3) * std::cos(2.0 * M_PI * 1.3 * t_s);
  }
  [[nodiscard]] double velocity_mps(double t_s) const {
    return speed_mps + 0.15 * std::sin(2.0 * M_PI * 1.3 * t_s);
  }
  [[nodiscard]] Pose at(double t_s) const {
    return {so3_exp({0.0, 0.0, 0.2 * t_s}), {x_m(t_s), 0.0, 0.0}};
  }
  /// What an IMU feels from one scan to the next, in the frame of the first.
  [[nodiscard]] ImuMotion felt(double t_s) const {
    const Eigen::Vector3d gained(velocity_mps(t_s + kMotion_s) - velocity_mps(t_s), 0.0, 0.0);
    ImuMotion motion;
    motion.velocity_mps = at(t_s).rotation.conjugate() * (gained - kMotion_s * kTiltedGravity_mps2);
    return motion;
  }
};

double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

TEST(StartLevel, WhoBeginsInMotionLearnsWhereDownIsInTwoSeconds) {
  const Walker walker;
  StartLevel level;
  int told = 0;
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (int k = 0; k < 40; ++k) {
    const double t_s = kMotion_s * k;
    const auto down =
        level.add(walker.at(t_s), walker.at(t_s + kMotion_s), walker.felt(t_s), kMotion_s);
    if (!down) continue;
    ++told;
    EXPECT_GT(k, 5);
    EXPECT_LT(k, 27);
    EXPECT_NEAR(down->norm(), kTiltedGravity_mps2.norm(), 0.1);
    EXPECT_LT(angle_rad(*down, kTiltedGravity_mps2), 0.02) << k;
    last = *down;
  }
  EXPECT_GT(told, 10);
  EXPECT_LT(angle_rad(last, kTiltedGravity_mps2), 0.004);
}

TEST(StartLevel, WhoBeginsAtRestIsToldNothing) {
  const Walker slow{0.0};
  StartLevel level;
  Pose there;
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(level.add(there, there, slow.felt(0.0), kMotion_s));
  }
  const Walker walker;
  for (int k = 3; k < 40; ++k) {
    const double t_s = kMotion_s * k;
    EXPECT_FALSE(
        level.add(walker.at(t_s), walker.at(t_s + kMotion_s), walker.felt(t_s), kMotion_s));
  }
  level.begin();
  bool told = false;
  for (int k = 0; k < 20; ++k) {
    const double t_s = kMotion_s * k;
    told |= level.add(walker.at(t_s), walker.at(t_s + kMotion_s), walker.felt(t_s), kMotion_s)
                .has_value();
  }
  EXPECT_TRUE(told) << "a new beginning counts";
}

}  // namespace
}  // namespace glint::slam
