// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/pose.hpp"

#include <gtest/gtest.h>

#include <random>

namespace glint {
namespace {

Twist random_twist(std::mt19937& random, double largest_angle_rad) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Twist twist;
  for (int i = 0; i < 6; ++i) twist[i] = unit(random);
  twist.tail<3>() *= largest_angle_rad / twist.tail<3>().norm() * std::abs(unit(random));
  return twist;
}

TEST(Pose, LogarithmUndoesExponential) {
  std::mt19937 random(2);
  for (const double angle_rad : {1e-9, 1e-5, 1e-3, 1.0, 3.1}) {
    for (int i = 0; i < 100; ++i) {
      const Twist twist = random_twist(random, angle_rad);
      EXPECT_LT((se3_log(se3_exp(twist)) - twist).norm(), 1e-7) << twist.transpose();
    }
  }
}

TEST(Pose, ExponentialOfATurnWhileDrivingIsACircle) {
  Twist twist;
  twist << M_PI / 2.0, 0, 0, 0, 0, M_PI / 2.0;
  const Pose pose = se3_exp(twist);
  EXPECT_LT((pose.translation_m - Eigen::Vector3d(1.0, 1.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((pose * Eigen::Vector3d(1.0, 0.0, 0.0) - Eigen::Vector3d(1.0, 2.0, 0.0)).norm(), 1e-12);
}

TEST(Pose, InverseUndoes) {
  std::mt19937 random(3);
  const Pose pose = se3_exp(random_twist(random, 2.0));
  const Pose none = pose * pose.inverse();
  EXPECT_LT(none.translation_m.norm(), 1e-12);
  EXPECT_LT(so3_log(none.rotation).norm(), 1e-12);
}

TEST(Pose, InterpolationEndsAtItsEndsAndExtrapolates) {
  std::mt19937 random(4);
  const Pose a = se3_exp(random_twist(random, 1.0));
  const Twist step = random_twist(random, 0.2);
  const Pose b = a * se3_exp(step);
  EXPECT_LT(se3_log(a.inverse() * interpolate(a, b, 0.0)).norm(), 1e-9);
  EXPECT_LT(se3_log(b.inverse() * interpolate(a, b, 1.0)).norm(), 1e-9);
  EXPECT_LT((se3_log(a.inverse() * interpolate(a, b, 1.5)) - 1.5 * step).norm(), 1e-9);
}

TEST(Pose, LogarithmOfHalfATurnHasTheLengthOfPi) {
  const Eigen::Vector3d half_turn = so3_log(Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0));
  EXPECT_NEAR(half_turn.norm(), M_PI, 1e-12);
}

}  // namespace
}  // namespace glint
