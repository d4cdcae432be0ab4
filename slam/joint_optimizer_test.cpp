// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/joint_optimizer.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace glint::slam {
namespace {

struct Scene {
  std::vector<PlaneTerm> planes;
  std::vector<PointTerm> points;
};

/// Floor and walls at right angles to `axes` (0 to 2), seen from `truth`, with noise.
Scene see(const Pose& truth, std::initializer_list<int> axes, int keypoints, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-10.0, 10.0);
  std::normal_distribution<double> noise(0.0, 0.01);
  Scene scene;
  const auto jitter = [&] { return Eigen::Vector3d(noise(random), noise(random), noise(random)); };
  for (const int axis : axes) {
    for (int i = 0; i < 200; ++i) {
      Eigen::Vector3d p(place(random), place(random), place(random));
      p[axis] = axis == 2 ? -1.5 : 4.0;
      const Eigen::Vector3d normal = Eigen::Vector3d::Unit(axis);
      scene.planes.push_back({truth.inverse() * p + jitter(), normal, p[axis], 1.0});
    }
  }
  for (int i = 0; i < keypoints; ++i) {
    const Eigen::Vector3d p(place(random), place(random), place(random));
    scene.points.push_back({truth.inverse() * p + jitter(), p, 1.0});
  }
  return scene;
}

const Pose kTruth{so3_exp({0.1, -0.05, 0.7}), {1.0, -2.0, 0.3}};
const Pose kStart = kTruth * se3_exp((Twist() << 0.2, -0.15, 0.1, 0.02, -0.03, 0.04).finished());

double distance_m(const Pose& a, const Pose& b) {
  return (a.translation_m - b.translation_m).norm();
}

TEST(JointOptimizer, PlanesAloneFixThePoseInARoom) {
  const Scene scene = see(kTruth, {0, 1, 2}, 0, 1);
  const JointResult result = optimize_jointly(kStart, {scene.planes, scene.points});
  ASSERT_TRUE(result.ok);
  EXPECT_LT(distance_m(result.T_odom_scan, kTruth), 0.005);
  EXPECT_LT(result.T_odom_scan.rotation.angularDistance(kTruth.rotation), 0.001);
  EXPECT_NEAR(result.plane_rms_m, 0.01, 0.002);
}

TEST(JointOptimizer, InACorridorPlanesAloneAreNotEnough) {
  const Scene scene = see(kTruth, {1, 2}, 0, 2);
  EXPECT_FALSE(optimize_jointly(kStart, {scene.planes, scene.points}).ok);
}

TEST(JointOptimizer, KeypointsFixWhatTheCorridorLeavesOpen) {
  const Scene scene = see(kTruth, {1, 2}, 60, 3);
  const JointResult result = optimize_jointly(kStart, {scene.planes, scene.points});
  ASSERT_TRUE(result.ok);
  EXPECT_LT(distance_m(result.T_odom_scan, kTruth), 0.01);
}

TEST(JointOptimizer, WrongPairsPullLittle) {
  Scene scene = see(kTruth, {0, 1, 2}, 100, 4);
  for (std::size_t i = 0; i < 15; ++i) scene.points[i].fixed_m.x() += 3.0;
  const JointResult result = optimize_jointly(kStart, {scene.planes, scene.points});
  ASSERT_TRUE(result.ok);
  EXPECT_LT(distance_m(result.T_odom_scan, kTruth), 0.03);
}

TEST(JointOptimizer, CurvatureIsThatOfTheResiduals) {
  // Central differences of half the plane terms' sum of squares.
  Scene scene = see(kTruth, {0, 1, 2}, 0, 5);
  const JointResult at_optimum = optimize_jointly(kStart, {scene.planes, {}});
  const auto cost = [&](const Twist& step) {
    Pose pose = at_optimum.T_odom_scan;
    pose.translation_m += pose.rotation * step.head<3>();
    pose.rotation = pose.rotation * so3_exp(step.tail<3>());
    double sum = 0.0;
    for (const PlaneTerm& term : scene.planes) {
      const double e = term.normal.dot(pose * term.point_m) - term.offset_m;
      sum += 0.5 * e * e;
    }
    return sum;
  };
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 6; ++i) {
    const Twist step = kStep * Twist::Unit(i);
    const double curvature =
        (cost(step) - 2.0 * cost(Twist::Zero()) + cost(-step)) / (kStep * kStep);
    EXPECT_NEAR(curvature, at_optimum.plane_hessian(i, i), 0.01 * curvature);
  }
}

}  // namespace
}  // namespace glint::slam
