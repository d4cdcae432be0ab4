// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/gravity_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glint::slam {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kGravity_mps2 = 9.80665;
constexpr double kScan_s = 0.1;

/// A walker who bobs, sways, turns, sets off and stops.
Pose pose_at(double t_s) {
  const Eigen::Vector3d position_m(0.3 * std::sin(0.9 * t_s) + t_s, 0.4 * std::sin(0.7 * t_s),
                                   0.03 * std::sin(12.0 * t_s));
  return {so3_exp({0.0, 0.0, 0.3 * t_s}) * so3_exp({0.1 * std::sin(2.0 * t_s), 0.05, 0.0}),
          position_m};
}

/// What its IMU feels from `t_s` on for a scan, integrated in fine steps.
ImuMotion felt_from(double t_s, const Eigen::Vector3d& bias_mps2) {
  constexpr int kSteps = 400;
  constexpr double kStep_s = kScan_s / kSteps;
  const Eigen::Quaterniond to_start = pose_at(t_s).rotation.conjugate();
  ImuMotion felt;
  for (int i = 0; i < kSteps; ++i) {
    const double at_s = t_s + (i + 0.5) * kStep_s;
    const Eigen::Vector3d acceleration_mps2 =
        (pose_at(at_s + 1e-3).translation_m - 2.0 * pose_at(at_s).translation_m +
         pose_at(at_s - 1e-3).translation_m) /
        1e-6;
    const Eigen::Vector3d force_mps2 =
        to_start * (acceleration_mps2 + kGravity_mps2 * Eigen::Vector3d::UnitZ() +
                    pose_at(at_s).rotation * bias_mps2);
    felt.way_m += (felt.velocity_mps + 0.5 * force_mps2 * kStep_s) * kStep_s;
    felt.velocity_mps += force_mps2 * kStep_s;
  }
  felt.turn = to_start * pose_at(t_s + kScan_s).rotation;
  return felt;
}

/// Walks for `seconds`; `odometry` is where odometry has the pose of a time.
template <typename Odometry>
GravityEstimate walk(double seconds, const Eigen::Vector3d& bias_mps2, const Odometry& odometry) {
  GravityEstimate estimate;
  for (int k = 0; k < std::lround(seconds / kScan_s); ++k) {
    estimate.add(odometry(k * kScan_s), odometry((k + 1) * kScan_s),
                 felt_from(k * kScan_s, bias_mps2), kScan_s);
  }
  return estimate;
}

double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(GravityEstimate, TellsUpFromTheWayASensorMoves) {
  const auto felt = walk(20.0, Eigen::Vector3d::Zero(), pose_at).felt();
  ASSERT_TRUE(felt);
  const Eigen::Vector3d up = pose_at(20.0).rotation.conjugate() * Eigen::Vector3d::UnitZ();
  EXPECT_LT(angle_rad(felt->up, up), 0.05 * kDegree);
  EXPECT_LT(felt->sigma_rad, 0.15 * kDegree);
}

TEST(GravityEstimate, JitterOfOdometryIsInItsSigma) {
  const auto jitter = [](double t_s) {
    Pose pose = pose_at(t_s);
    pose.translation_m += 0.02 * Eigen::Vector3d(std::sin(987.0 * t_s), std::sin(1234.0 * t_s),
                                                 std::sin(2345.0 * t_s));
    return pose;
  };
  const auto felt = walk(20.0, Eigen::Vector3d::Zero(), jitter).felt();
  ASSERT_TRUE(felt);
  const Eigen::Vector3d up = pose_at(20.0).rotation.conjugate() * Eigen::Vector3d::UnitZ();
  EXPECT_LT(angle_rad(felt->up, up), 2.0 * felt->sigma_rad);
  EXPECT_LT(felt->sigma_rad, 0.5 * kDegree);
}

TEST(GravityEstimate, TheBiasAddsWhatItSays) {
  const Eigen::Vector3d bias_mps2(0.3, -0.2, 0.0);
  const auto felt = walk(20.0, bias_mps2, pose_at).felt();
  ASSERT_TRUE(felt);
  const Eigen::Vector3d up = pose_at(20.0).rotation.conjugate() * Eigen::Vector3d::UnitZ();
  EXPECT_GT(angle_rad(felt->up, up), 1.0 * kDegree);
  const Eigen::Vector3d foretold = up + felt->bias_share * bias_mps2 / kGravity_mps2;
  EXPECT_LT(angle_rad(felt->up, foretold), 0.1 * kDegree);
}

TEST(GravityEstimate, OdometryThatTiltsShows) {
  // Odometry that went askew long ago by 3 degrees knows its way as well as ever.
  const Pose askew{so3_exp({3.0 * kDegree, 0.0, 0.0}), {5.0, 1.0, 2.0}};
  const auto tilted = [&](double t_s) { return t_s < 8.0 ? pose_at(t_s) : askew * pose_at(t_s); };
  const auto felt = walk(20.0, Eigen::Vector3d::Zero(), tilted).felt();
  ASSERT_TRUE(felt);
  const Eigen::Vector3d up_by_odometry = tilted(20.0).rotation * felt->up;
  EXPECT_NEAR(angle_rad(up_by_odometry, Eigen::Vector3d::UnitZ()), 3.0 * kDegree, 0.05 * kDegree);
}

TEST(GravityEstimate, NothingIsSaidEarlyOrAfterAGap) {
  EXPECT_FALSE(walk(3.0, Eigen::Vector3d::Zero(), pose_at).felt());
  GravityEstimate estimate = walk(10.0, Eigen::Vector3d::Zero(), pose_at);
  EXPECT_TRUE(estimate.felt());
  // The next motion does not begin where the last one ended.
  estimate.add(pose_at(11.0), pose_at(11.1), felt_from(11.0, Eigen::Vector3d::Zero()), kScan_s);
  EXPECT_FALSE(estimate.felt());
}

TEST(GravityEstimate, ForcesThatDoNotGoWithTheWayAreNotBelieved) {
  // Odometry stands still while the sensor is carried off at a steady 2 m/s^2.
  EXPECT_FALSE(walk(20.0, {0.0, 0.0, 2.0}, pose_at).felt());
}

}  // namespace
}  // namespace glint::slam
