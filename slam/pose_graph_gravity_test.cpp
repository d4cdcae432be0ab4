// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>

#include "slam/pose_graph.hpp"

namespace glint::slam {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr std::uint64_t kSteps = 400;

/// Along a winding road, a metre a second.
Pose true_pose(std::uint64_t k) {
  const double x_m = static_cast<double>(k);
  const double y_m = 30.0 * std::sin(x_m / 40.0);
  return {so3_exp({0, 0, std::atan(0.75 * std::cos(x_m / 40.0))}), {x_m, y_m, 0.0}};
}

struct Ride {
  Twist drift = Twist::Zero();
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  bool gravity = true;
  std::uint64_t spoilt = kSteps;  ///< What is felt there is wrong by 20 degrees.
};

class GravityInPoseGraph : public testing::Test {
 protected:
  /// Returns how often the graph asked to be levelled.
  int ride(const Ride& how) {
    const Pose drift = se3_exp(how.drift);
    Pose T_odom_sensor;
    int levelled = 0;
    for (std::uint64_t k = 0; k < kSteps; ++k) {
      if (k > 0)
        T_odom_sensor = T_odom_sensor * (true_pose(k - 1).inverse() * true_pose(k)) * drift;
      Keyframe keyframe;
      keyframe.id = k;
      keyframe.estimate.T_odom_sensor = T_odom_sensor;
      keyframe.estimate.stamp.ns = static_cast<std::int64_t>(k) * 1'000'000'000;
      const Eigen::Vector3d up = true_pose(k).rotation.conjugate() * Eigen::Vector3d::UnitZ();
      if (how.gravity) {
        keyframe.gravity = {(up + how.bias).normalized(), Eigen::Matrix3d::Identity(),
                            0.15 * kDegree};
        if (k >= how.spoilt && k < how.spoilt + 8) {
          keyframe.gravity->up = so3_exp({0.35, 0, 0}) * keyframe.gravity->up;
        }
      }
      graph_->add(keyframe);
      if (!graph_->tilted()) continue;
      ++levelled;
      graph_->optimize();
    }
    return levelled;
  }
  void begin_anew(const PoseGraphOptions& options) { graph_.emplace(options); }
  double largest_tilt_rad() const {
    double largest = 0.0;
    for (const Pose& pose : graph_->poses()) {
      const Eigen::Vector3d up = pose.rotation * Eigen::Vector3d::UnitZ();
      largest = std::max(largest, std::acos(std::min(1.0, up.z())));
    }
    return largest;
  }
  double largest_height_m() const {
    double largest_m = 0.0;
    for (const Pose& pose : graph_->poses()) {
      largest_m = std::max(largest_m, std::abs(pose.translation_m.z()));
    }
    return largest_m;
  }
  std::optional<PoseGraph> graph_{std::in_place};
};

Twist pitching(double per_metre_rad) {
  Twist drift = Twist::Zero();
  drift[4] = per_metre_rad;
  return drift;
}

TEST_F(GravityInPoseGraph, OdometryThatTiltsIsKeptLevelWithoutALoop) {
  const Ride tilting{.drift = pitching(0.02 * kDegree)};
  EXPECT_GT(ride(tilting), 0);
  const double height_m = largest_height_m();
  const double tilt_rad = largest_tilt_rad();
  EXPECT_LT(tilt_rad, 1.2 * kDegree);
  EXPECT_TRUE(graph_->poses()[0].translation_m.isZero(0.0)) << "the first keyframe holds the map";

  begin_anew({.gravity = false});
  EXPECT_EQ(ride(tilting), 0);
  EXPECT_GT(largest_tilt_rad(), 2.0 * tilt_rad);
  EXPECT_GT(largest_height_m(), 2.0 * height_m);
}

TEST_F(GravityInPoseGraph, GoodOdometryIsLeftAloneAndABiasTurnsNothing) {
  EXPECT_EQ(ride({.bias = {0.03, -0.02, 0.0}}), 0);
}

TEST_F(GravityInPoseGraph, ABiasIsNotTakenForTilt) {
  ride({.drift = pitching(0.02 * kDegree), .bias = {0.03, -0.02, 0.0}});
  EXPECT_LT(largest_tilt_rad(), 1.6 * kDegree);
}

TEST_F(GravityInPoseGraph, ALoopThatIsWrongInRollDoesNotTiltTheMap) {
  ride({});
  LoopEdge loop{10, 110, true_pose(10).inverse() * true_pose(110), {}};
  loop.T_from_to.rotation = loop.T_from_to.rotation * so3_exp({3.0 * kDegree, 0.0, 0.0});
  loop.covariance = Eigen::Matrix<double, 6, 6>::Identity() * 1e-4;
  loop.covariance.bottomRightCorner<3, 3>() *= 10.0;
  graph_->add_loop(loop);
  graph_->optimize();
  const double tilt_rad = largest_tilt_rad();
  EXPECT_EQ(graph_->loop_count(), 1U);

  begin_anew({.gravity = false});
  ride({});
  graph_->add_loop(loop);
  graph_->optimize();
  EXPECT_EQ(graph_->loop_count(), 1U);
  EXPECT_GT(largest_tilt_rad(), 1.7 * tilt_rad);
}

TEST_F(GravityInPoseGraph, WhatIsFeltWronglyOnceCountsForLittle) {
  ride({.spoilt = 200});
  graph_->optimize();
  EXPECT_LT(largest_tilt_rad(), 0.5 * kDegree);
}

TEST_F(GravityInPoseGraph, WithoutAnImuNothingChanges) {
  EXPECT_EQ(ride({.drift = pitching(0.02 * kDegree), .gravity = false}), 0);
}

}  // namespace
}  // namespace glint::slam
