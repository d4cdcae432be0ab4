// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/degeneracy.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "slam/blind_drift.hpp"
#include "slam/joint_optimizer.hpp"

namespace glint::slam {
namespace {

const Pose kPose{so3_exp({0.05, -0.03, 0.6}), {3.0, 1.0, 0.2}};

/// Walls across the odometry frame's axes (0 to 2), whose normals are noisy as those of fitted
/// planes are, seen from kPose.
std::vector<PlaneTerm> walls(std::initializer_list<int> axes, double noise_rad = 0.02) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, noise_rad);
  std::uniform_real_distribution<double> place(-10.0, 10.0);
  std::vector<PlaneTerm> terms;
  for (const int axis : axes) {
    for (int i = 0; i < 300; ++i) {
      Eigen::Vector3d p_m(place(random), place(random), place(random));
      p_m[axis] = 4.0;
      const Eigen::Vector3d tilt(noise(random), noise(random), noise(random));
      const Eigen::Vector3d normal = (Eigen::Vector3d::Unit(axis) + tilt).normalized();
      terms.push_back({kPose.inverse() * p_m, normal, normal.dot(p_m), 1.0});
    }
  }
  return terms;
}

std::vector<PointTerm> keypoints(int count, double turn_rad, double noise_m) {
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0.0, noise_m);
  std::vector<PointTerm> points;
  for (int i = 0; i < count; ++i) {
    const double angle = turn_rad * i / count;
    const Eigen::Vector3d p_m(5.0 * std::cos(angle), 5.0 * std::sin(angle), 0.5);
    const Eigen::Vector3d off_m(noise(random), noise(random), noise(random));
    // Seen by two scans.
    points.push_back({p_m, kPose * p_m + off_m, 1.0});
    points.push_back({p_m, kPose * p_m + off_m, 1.0});
  }
  return points;
}

TEST(Degeneracy, ARoomHoldsEveryAxis) {
  EXPECT_TRUE(find_weak_axes(walls({0, 1, 2}), kPose, {}).empty());
}

TEST(Degeneracy, ACorridorLeavesItsOwnDirectionOpen) {
  const WeakAxes weak = find_weak_axes(walls({1, 2}), kPose, {});
  ASSERT_EQ(weak.size(), 1U);
  EXPECT_FALSE(weak.begin()->rotation);
  EXPECT_GT(std::abs(weak.begin()->axis.x()), 0.99);
}

TEST(Degeneracy, AFloorAloneHoldsHeightRollAndPitch) {
  const WeakAxes weak = find_weak_axes(walls({2}), kPose, {});
  ASSERT_EQ(weak.size(), 3U);
  const WeakAxis& turn = *(weak.begin() + 2);
  EXPECT_TRUE(turn.rotation);
  EXPECT_GT(std::abs(turn.axis.z()), 0.99);
}

TEST(Degeneracy, AGentleSlopeHoldsMoreThanNoise) {
  // As much as normals 5 degrees off do: meadows are not flat.
  EXPECT_LT(find_weak_axes(walls({2}, 0.09), kPose, {}).size(), 3U);
}

TEST(Degeneracy, WhatWasWeakMustBeHeldClearly) {
  // Barely held: a few points on the end of the corridor.
  auto planes = walls({1, 2});
  const auto end = walls({0});
  planes.insert(planes.end(), end.begin(), end.begin() + 2);
  EXPECT_TRUE(find_weak_axes(planes, kPose, {}).empty());
  const WeakAxes before = find_weak_axes(walls({1, 2}), kPose, {});
  EXPECT_EQ(find_weak_axes(planes, kPose, before).size(), 1U);
  planes.insert(planes.end(), end.begin(), end.begin() + 5);
  EXPECT_TRUE(find_weak_axes(planes, kPose, before).empty());
}

TEST(Degeneracy, KeypointsCarryAnAxisWhenManyAllAroundAgree) {
  const WeakAxis along{.axis = Eigen::Vector3d::UnitX()};
  const double all_around = 6.2;
  EXPECT_TRUE(carried_by_points(along, keypoints(40, all_around, 0.01), kPose));
  EXPECT_FALSE(carried_by_points(along, keypoints(10, all_around, 0.01), kPose)) << "few";
  EXPECT_FALSE(carried_by_points(along, keypoints(40, 0.5, 0.01), kPose)) << "on one side";
  EXPECT_FALSE(carried_by_points(along, keypoints(40, all_around, 0.5), kPose)) << "at odds";
  const WeakAxis about{.rotation = true, .axis = Eigen::Vector3d::UnitZ()};
  EXPECT_TRUE(carried_by_points(about, keypoints(40, all_around, 0.01), kPose));
}

TEST(Degeneracy, AlongAWeakAxisThePriorDecidesAndElsewhereTheWalls) {
  const auto planes = walls({1, 2});
  const WeakAxes weak = find_weak_axes(planes, kPose, {});
  PosePrior prior;
  prior.T_odom_scan = kPose * se3_exp((Twist() << 0.2, 0.1, 0.1, 0.01, 0.01, 0.01).finished());
  prior.information.diagonal().setConstant(0.01);
  JointTerms terms;
  terms.planes = planes;
  terms.prior = prior;
  terms.plane_projection = projection_without(weak, kPose);
  const JointResult result = optimize_jointly(prior.T_odom_scan, terms);
  ASSERT_TRUE(result.ok);
  const Eigen::Vector3d expected_m = prior.T_odom_scan.translation_m;
  EXPECT_NEAR(result.T_odom_scan.translation_m.x(), expected_m.x(), 0.01);
  EXPECT_NEAR(result.T_odom_scan.translation_m.y(), kPose.translation_m.y(), 0.01);
  EXPECT_NEAR(result.T_odom_scan.translation_m.z(), kPose.translation_m.z(), 0.01);
  EXPECT_LT(result.T_odom_scan.rotation.angularDistance(kPose.rotation), 0.002);
}

TEST(BlindDrift, GrowsWithTimeNotWithItsRootAndIsToldAfterThreeScans) {
  WeakAxes blind;
  blind.add(
      {.rotation = false, .axis = kPose.rotation * Eigen::Vector3d::UnitX(), .critical = true});
  BlindDrift drift;
  const Twist velocity = (Twist() << 1.0, 0, 0, 0, 0, 0).finished();
  double variance_m2 = 0.0;
  double after_one_s_m = 0.0;
  for (int scan = 1; scan <= 20; ++scan) {
    const auto added = drift.add(blind, kPose, velocity, 0.1);
    EXPECT_EQ(drift.is_blind(), scan >= 3);
    EXPECT_NEAR(added(1, 1), 0.0, 1e-12) << "only along the axis";
    variance_m2 += added(0, 0);
    if (scan == 10) after_one_s_m = std::sqrt(variance_m2);
  }
  EXPECT_GT(std::sqrt(variance_m2), 2.0 * after_one_s_m);
  for (int scan = 0; scan < 3; ++scan) EXPECT_EQ(drift.add({}, kPose, velocity, 0.1).norm(), 0.0);
  EXPECT_FALSE(drift.is_blind());
}

// An axis that keypoints or patches carry is not blind, but they drift with the way.
TEST(BlindDrift, WhatIsCarriedDriftsWithTheWayAlongItsAxisAlone) {
  WeakAxes carried;
  carried.add({.rotation = false, .axis = kPose.rotation * Eigen::Vector3d::UnitX()});
  carried.add({.rotation = true, .axis = kPose.rotation * Eigen::Vector3d::UnitX()});
  const auto gained_in_one_s = [&](double speed_mps) {
    BlindDrift drift;
    Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
    const Twist velocity = (Twist() << speed_mps, 0, 0, 0, 0, 0).finished();
    for (int scan = 0; scan < 10; ++scan) sum += drift.add(carried, kPose, velocity, 0.1);
    EXPECT_FALSE(drift.is_blind());
    return sum;
  };
  const auto fast = gained_in_one_s(8.0);
  EXPECT_NEAR(std::sqrt(fast(0, 0)), 0.012, 1e-6);
  EXPECT_NEAR(fast(1, 1) + fast(2, 2), 0.0, 1e-12);
  EXPECT_NEAR(fast.bottomRightCorner(3, 3).norm(), 0.0, 1e-12) << "turns are the gyroscope's";
  EXPECT_NEAR(fast(0, 0), 16.0 * gained_in_one_s(2.0)(0, 0), 1e-9);
  EXPECT_EQ(gained_in_one_s(0.0).norm(), 0.0);
}

}  // namespace
}  // namespace glint::slam
