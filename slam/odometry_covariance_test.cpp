// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/odometry_covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glint::slam {
namespace {

using Matrix6 = OdometryCovariance::Matrix6;

Matrix6 small_turns() {
  Matrix6 covariance = Matrix6::Identity() * 1e-12;
  covariance(5, 5) = 1e-6;  // 1 mrad about z
  return covariance;
}

TEST(OdometryCovariance, AnUncertainTurnMovesWhatComesAfter) {
  OdometryCovariance covariance;
  OdometryCovariance exact;  // The origin's share, carried along.
  const auto gained = [&] { return Matrix6(covariance.since_origin() - exact.since_origin()); };
  const Pose ahead{Eigen::Quaterniond::Identity(), {10.0, 0.0, 0.0}};
  covariance.add(ahead, small_turns());
  exact.add(ahead, Matrix6::Zero());
  EXPECT_NEAR(gained()(1, 1), 0.0, 1e-9) << "turned at its end only";
  covariance.add(ahead, small_turns());
  exact.add(ahead, Matrix6::Zero());
  EXPECT_NEAR(std::sqrt(gained()(1, 1)), 0.01, 1e-4) << "1 mrad over 10 m";
  EXPECT_NEAR(gained()(5, 5), 2e-6, 1e-9);
}

TEST(OdometryCovariance, KeyframesTakeTheirPart) {
  OdometryCovariance covariance;
  covariance.add({}, small_turns());
  EXPECT_NEAR(covariance.take_since_keyframe()(5, 5), 1e-6, 1e-9);
  covariance.add({}, small_turns());
  covariance.coast();
  EXPECT_GT(covariance.take_since_keyframe()(5, 5), 1e-3) << "nobody saw that scan";
  EXPECT_EQ(covariance.take_since_keyframe(), Matrix6(Matrix6::Zero()));
  EXPECT_GT(covariance.since_origin()(5, 5), 1e-3);
  covariance.reset();
  EXPECT_EQ(covariance.since_origin(), OdometryCovariance().since_origin());
  EXPECT_GT(covariance.since_origin()(0, 0), 0.0) << "the first scan is not exact";
}

TEST(OdometryCovariance, DriftGoesWithTimeNotWithScans) {
  const Matrix6 own = Matrix6::Identity();
  EXPECT_NEAR(10.0 * drift_gained(own, 0.1)(0, 0), 20.0 * drift_gained(own, 0.05)(0, 0), 1e-9);
}

}  // namespace
}  // namespace glint::slam
