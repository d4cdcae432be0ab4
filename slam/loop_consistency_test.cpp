// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loop_consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "slam/pose_graph.hpp"

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr std::uint64_t kRound = 100;

/// Round a circle, a metre a step; again and again.
Pose circle_pose(std::uint64_t k) {
  const double angle_rad = 2.0 * M_PI * static_cast<double>(k) / kRound;
  const double radius_m = kRound / (2.0 * M_PI);
  return {so3_exp({0, 0, angle_rad}),
          {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad)), 0.0}};
}

/// As the world is, or as another corridor of one make would have it: off by `false_m` along.
LoopEdge loop_between(std::uint64_t from, std::uint64_t to, double false_m = 0.0) {
  const Pose off{Eigen::Quaterniond::Identity(), {0.0, false_m, 0.0}};
  return {from, to, circle_pose(from).inverse() * (off * circle_pose(to)),
          Matrix6::Identity() * 1e-4};
}

GraphEdge edge_of(const LoopEdge& loop) {
  return {loop.from, loop.to, loop.T_from_to, whitening_of(loop.covariance), true};
}

class LoopPairs : public testing::Test {
 protected:
  void SetUp() override {
    for (std::uint64_t k = 0; k < 3 * kRound; ++k) {
      // From the 250th on tracking had been lost.
      consistency_.add({k, k, k < 250 ? 0U : 1U, circle_pose(k)}, Matrix6::Identity() * 1e-5);
    }
  }
  bool contradict(const LoopEdge& a, const LoopEdge& b) const {
    EXPECT_EQ(consistency_.contradict(edge_of(a), edge_of(b)),
              consistency_.contradict(edge_of(b), edge_of(a)));
    return consistency_.contradict(edge_of(a), edge_of(b));
  }
  LoopConsistency consistency_;
};

TEST_F(LoopPairs, TrueOnesAgreeAndAFalseOneContradicts) {
  EXPECT_FALSE(contradict(loop_between(5, 105), loop_between(15, 115)));
  EXPECT_FALSE(contradict(loop_between(5, 115), loop_between(25, 105)));
  EXPECT_TRUE(contradict(loop_between(5, 105), loop_between(15, 115, 3.0)));
  EXPECT_FALSE(contradict(loop_between(5, 105, 3.0), loop_between(15, 115, 3.0)));
}

TEST_F(LoopPairs, ADifferenceThatOdometryMayHaveMadeIsNone) {
  EXPECT_TRUE(contradict(loop_between(5, 105), loop_between(6, 106, 0.2)));
  EXPECT_FALSE(contradict(loop_between(5, 105), loop_between(40, 140, 0.2)));
}

TEST_F(LoopPairs, NothingIsSaidAcrossALongWayOrALoss) {
  EXPECT_FALSE(contradict(loop_between(5, 105), loop_between(90, 190, 30.0)));
  EXPECT_FALSE(contradict(loop_between(45, 245), loop_between(55, 255, 30.0)));
  EXPECT_TRUE(contradict(loop_between(45, 255), loop_between(55, 265, 30.0)));
}

TEST(LargestAgreeing, AMajorityOverthrowsWhatWasSettled) {
  // 0 and 1 are settled; 2 and 3, set aside, and the new 4 each contradict both.
  std::vector<LoopVote> loops{{{2, 3, 4}, true, false},
                              {{2, 3, 4}, true, false},
                              {{0, 1}, false, true},
                              {{0, 1}, false, true},
                              {{0, 1}, false, false}};
  EXPECT_EQ(largest_agreeing(loops), (std::vector<bool>{false, false, true, true, true}));
}

TEST(LargestAgreeing, OfEqualSetsTheSettledOneStays) {
  std::vector<LoopVote> loops{
      {{2, 3}, true, false}, {{2, 3}, true, false}, {{0, 1}, false, true}, {{0, 1}, false, false}};
  EXPECT_EQ(largest_agreeing(loops), (std::vector<bool>{true, true, false, false}));
}

TEST(LargestAgreeing, WhatWasSetAsideDoesNotComeBackForNothing) {
  std::vector<LoopVote> loops{
      {{}, true, false}, {{2}, false, false}, {{1}, false, true}, {{}, false, true}};
  EXPECT_EQ(largest_agreeing(loops), (std::vector<bool>{true, true, false, false}));
}

/// Two rounds, drifting, then loops as they come.
class TwoRounds : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    Pose T_odom_sensor;
    const Pose drift = se3_exp((Twist() << 0.002, 0, 0, 0, 0, 0.0005).finished());
    for (std::uint64_t k = 0; k < 2 * kRound; ++k) {
      if (k > 0) {
        T_odom_sensor = T_odom_sensor * (circle_pose(k - 1).inverse() * circle_pose(k)) * drift;
      }
      Keyframe keyframe;
      keyframe.id = k;
      keyframe.estimate.T_odom_sensor = T_odom_sensor;
      graph_.add(keyframe);
    }
  }
  void close(const LoopEdge& loop) {
    graph_.add_loop(loop);
    graph_.optimize();
  }
  double error_m(std::uint64_t from) const {
    return graph_.misfit(loop_between(from, from + kRound))->distance_m;
  }
  PoseGraph graph_{{.loop_consistency = GetParam()}};
};

// Another corridor of one make was taken for this one, until the sensor came out of it.
TEST_P(TwoRounds, AClusterOfFalseLoopsThatCameFirstIsOutvoted) {
  for (std::uint64_t k = 10; k < 16; ++k) close(loop_between(k, k + kRound, 4.0));
  EXPECT_GT(error_m(20), 2.0);
  for (std::uint64_t k = 18; k < 28; ++k) close(loop_between(k, k + kRound));
  if (GetParam()) {
    EXPECT_LT(error_m(22), 0.1);
    EXPECT_EQ(graph_.loop_count(), 10U) << "those that were refused at first are back";
  } else {
    EXPECT_GT(error_m(22), 0.5) << "the worst one was the single right one, each time";
  }
}

TEST_P(TwoRounds, AClusterOfFalseLoopsAgainstALargerOneOfRightOnesGoes) {
  for (std::uint64_t k = 10; k < 22; ++k) close(loop_between(k, k + kRound));
  for (std::uint64_t k = 24; k < 30; ++k) graph_.add_loop(loop_between(k, k + kRound, 4.0));
  EXPECT_EQ(graph_.optimize().size(), 6U);
  EXPECT_LT(error_m(18), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Consistency, TwoRounds, testing::Bool());

}  // namespace
}  // namespace glint::slam
