// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/patch_gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace glint::slam {
namespace {

constexpr double kSigma_m = 0.1;
// Of the motion, where chi^2 reaches 95 %.
constexpr double kPatchGate_m = 1.96 * kSigma_m;

WeakAxes weak_along(const Eigen::Vector3d& axis) {
  WeakAxes axes;
  axes.add({false, axis, false});
  return axes;
}

// The scan is turned: its axes are not those of the odometry.
Pose placed(const Eigen::Vector3d& at_m = Eigen::Vector3d::Zero()) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ())),
          Eigen::Vector3d(4.0, -2.0, 1.0) + at_m};
}

// Sure to `sigma_m` along the scan's axes.
PosePrior motion(const Eigen::Vector3d& sigma_m) {
  PosePrior prior;
  prior.T_odom_scan = placed();
  prior.information.diagonal().head<3>() = sigma_m.cwiseAbs2().cwiseInverse();
  prior.information.diagonal().tail<3>().setConstant(1e6);
  return prior;
}

const PosePrior kMotion = motion(Eigen::Vector3d::Constant(kSigma_m));

TEST(PatchGate, WhatIsWithinTheMotionsGateAgrees) {
  const WeakAxes along_x = weak_along(Eigen::Vector3d::UnitX());
  for (const double way_m : {0.0, 0.95 * kPatchGate_m, -0.95 * kPatchGate_m}) {
    EXPECT_TRUE(agrees_with_motion(placed({way_m, 0.0, 0.0}), kMotion, along_x)) << way_m;
  }
}

TEST(PatchGate, WhatIsBeyondItContradicts) {
  const WeakAxes along_x = weak_along(Eigen::Vector3d::UnitX());
  for (const double way_m : {1.05 * kPatchGate_m, -1.05 * kPatchGate_m, 3.0}) {
    EXPECT_FALSE(agrees_with_motion(placed({way_m, 0.0, 0.0}), kMotion, along_x)) << way_m;
  }
}

TEST(PatchGate, OnlyWeakAxesAreLookedAlong) {
  const Pose off_along_y = placed({0.0, 2.0 * kPatchGate_m, 0.0});
  EXPECT_TRUE(agrees_with_motion(off_along_y, kMotion, {}));
  WeakAxes axes = weak_along(Eigen::Vector3d::UnitX());
  EXPECT_TRUE(agrees_with_motion(off_along_y, kMotion, axes));
  axes.add({true, Eigen::Vector3d::UnitY(), false});
  EXPECT_TRUE(agrees_with_motion(off_along_y, kMotion, axes));
  // Each of them counts.
  axes.add({false, Eigen::Vector3d::UnitY(), false});
  EXPECT_FALSE(agrees_with_motion(off_along_y, kMotion, axes));
}

TEST(PatchGate, TheMotionsSurenessIsThatOfTheScansAxes) {
  // Turned by a quarter, the odometry's x is the scan's -y.
  const PosePrior vague_along_x = motion({kSigma_m, 10.0 * kSigma_m, kSigma_m});
  EXPECT_TRUE(agrees_with_motion(placed({2.0 * kPatchGate_m, 0.0, 0.0}), vague_along_x,
                                 weak_along(Eigen::Vector3d::UnitX())));
  EXPECT_FALSE(agrees_with_motion(placed({0.0, 2.0 * kPatchGate_m, 0.0}), vague_along_x,
                                  weak_along(Eigen::Vector3d::UnitY())));
}

TEST(PatchGate, FewPatchesOrThoseOnOneSideOutvoteNothing) {
  PatchVotes votes;
  votes.patches = 12;
  votes.sectors = 3;
  EXPECT_TRUE(outvote_keypoints(votes));
  votes.sectors = 2;
  EXPECT_FALSE(outvote_keypoints(votes));
  votes = {};
  votes.patches = 11;
  votes.sectors = 8;
  EXPECT_FALSE(outvote_keypoints(votes));
}

// Where a keypoint was seen before, if it now seems to be `off_m` from there.
PointTerm keypoint(const Eigen::Vector3d& point_m, const Eigen::Vector3d& off_m) {
  return {point_m, placed() * point_m - off_m, 1.0};
}

TEST(PatchGate, KeypointsThatGoWithTheSensorAlongAWeakAxisAreDropped) {
  const Eigen::Vector3d here_m(3.0, 1.0, 0.0);
  std::vector<PointTerm> points = {
      keypoint(here_m, {0.07, 0.0, 0.0}), keypoint(here_m, {0.09, 0.0, 0.0}),
      keypoint(here_m, {-0.09, 0.0, 0.0}), keypoint(here_m, {0.0, 0.5, 0.0})};
  WeakAxes axes = weak_along(Eigen::Vector3d::UnitX());
  axes.add({true, Eigen::Vector3d::UnitY(), false});
  drop_contradicting(axes, placed(), points);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].fixed_m, keypoint(here_m, {0.07, 0.0, 0.0}).fixed_m);
  EXPECT_EQ(points[1].fixed_m, keypoint(here_m, {0.0, 0.5, 0.0}).fixed_m);
}

class PatchJudgement : public testing::Test {
 protected:
  PatchJudgement() {
    axes_.add({false, Eigen::Vector3d::UnitX(), false});
    axes_.add({true, Eigen::Vector3d::UnitZ(), false});
    enough_.patches = 12;
    enough_.sectors = 3;
    for (int i = 0; i < 16; ++i) {
      const double angle_rad = i * std::numbers::pi / 8.0;
      around_.push_back(
          keypoint({5.0 * std::cos(angle_rad), 5.0 * std::sin(angle_rad), 0.0}, {0.0, 0.0, 0.0}));
    }
  }
  [[nodiscard]] bool critical_along() const { return axes_.begin()->critical; }
  [[nodiscard]] bool critical_about() const { return (axes_.begin() + 1)->critical; }

  WeakAxes axes_;
  PatchVotes enough_;
  std::vector<PointTerm> around_;
};

TEST_F(PatchJudgement, WithoutPatchesKeypointsAndGyroscopeAllIsCritical) {
  judge_axes(axes_, {}, {}, placed(), false);
  EXPECT_TRUE(critical_along());
  EXPECT_TRUE(critical_about());
}

TEST_F(PatchJudgement, PatchesTellOfAWayAndTheGyroscopeOfATurn) {
  judge_axes(axes_, enough_, {}, placed(), false);
  EXPECT_FALSE(critical_along());
  EXPECT_TRUE(critical_about());
  judge_axes(axes_, {}, {}, placed(), true);
  EXPECT_TRUE(critical_along());
  EXPECT_FALSE(critical_about());
}

TEST_F(PatchJudgement, KeypointsAllAroundTellOfBoth) {
  judge_axes(axes_, {}, around_, placed(), false);
  EXPECT_FALSE(critical_along());
  EXPECT_FALSE(critical_about());
}

}  // namespace
}  // namespace glint::slam
