// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/gravity.hpp"

#include <gtest/gtest.h>

#include <random>

namespace glint {
namespace {

constexpr double kG_mps2 = 9.81;

class GravityTest : public testing::Test {
 protected:
  // Measurements at 100 Hz of a noisy IMU that feels `acceleration` and turns at `rate`.
  void feed(double seconds, const Eigen::Vector3d& acceleration,
            const Eigen::Vector3d& rate = Eigen::Vector3d::Zero(), double shake_mps2 = 0.05) {
    for (int i = 0; i < seconds * 100; ++i) {
      time_ = time_ + 10'000'000;
      gravity_.add({time_, time_, acceleration + shake_mps2 * noise(), rate + 0.003 * noise()});
    }
  }
  Eigen::Vector3d noise() { return {normal_(random_), normal_(random_), normal_(random_)}; }

  SensorTime time_{1'000'000'000};
  GravityEstimate gravity_;
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_;
};

TEST_F(GravityTest, AtRestTheAccelerometerShowsUp) {
  const Eigen::Vector3d up = kG_mps2 * Eigen::Vector3d(0.3, -0.2, 0.9).normalized();
  feed(3.0, up);
  ASSERT_TRUE(gravity_.up_mps2());
  EXPECT_LT((*gravity_.up_mps2() - up).norm(), 0.02);
  EXPECT_NEAR(gravity_.rate_hz(), 100.0, 0.1);
}

TEST_F(GravityTest, NothingIsLearntInMotion) {
  feed(3.0, {0, 0, kG_mps2}, {0, 0, 0.5});
  EXPECT_FALSE(gravity_.up_mps2()) << "turning";
  feed(3.0, {0, 0, kG_mps2}, Eigen::Vector3d::Zero(), 2.0);
  EXPECT_FALSE(gravity_.up_mps2()) << "shaking";
  feed(3.0, {4.0, 0, kG_mps2});
  EXPECT_FALSE(gravity_.up_mps2()) << "accelerating";
}

TEST_F(GravityTest, WhatWasLearntAtRestIsKeptInMotionAndFollowsLater) {
  feed(3.0, {0, 0, kG_mps2});
  feed(3.0, {0, kG_mps2, 0}, {1.0, 0, 0});
  EXPECT_GT(gravity_.up_mps2()->z(), 9.7);
  feed(20.0, {0, kG_mps2, 0});
  EXPECT_GT(gravity_.up_mps2()->y(), 9.7);
}

TEST_F(GravityTest, AClockThatGoesBackOrALongGapBeginsAnew) {
  feed(0.4, {0, 0, kG_mps2});
  time_ = time_ + -3'000'000'000;
  feed(0.4, {0, 0, kG_mps2});
  time_ = time_ + 3'600'000'000'000;
  feed(0.4, {0, 0, kG_mps2});
  EXPECT_FALSE(gravity_.up_mps2());
  feed(0.2, {0, 0, kG_mps2});
  EXPECT_TRUE(gravity_.up_mps2());
  EXPECT_NEAR(gravity_.rate_hz(), 100.0, 0.1);
}

TEST(MountTilt, IsTheAngleBetweenMeasuredAndMountedUp) {
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond upside_down(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond pitched(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d up(0, 0, kG_mps2);
  EXPECT_NEAR(mount_tilt_deg(up, level), 0.0, 1e-6);
  EXPECT_NEAR(mount_tilt_deg(up, upside_down), 180.0, 1e-5);
  EXPECT_NEAR(mount_tilt_deg(-up, upside_down), 0.0, 1e-5);
  // A base that stands level feels up at R_base_sensor^-1 * z.
  EXPECT_NEAR(mount_tilt_deg(pitched.inverse() * up, pitched), 0.0, 1e-5);
  EXPECT_NEAR(mount_tilt_deg(up, pitched), 0.5 * 180.0 / M_PI, 1e-6);
}

}  // namespace
}  // namespace glint
