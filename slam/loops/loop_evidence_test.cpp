// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/loop_evidence.hpp"

#include <gtest/gtest.h>

namespace glint::slam {
namespace {

/// A sensor that goes along x: what it sees at `older_m` it sees again at `current_m` of its path,
/// off by `error_m` to the side.
PlacePair pair_at(double older_m, double current_m, double error_m = 0.0) {
  PlacePair pair;
  pair.older.path_m = older_m;
  pair.older.T_odom_sensor.translation_m.x() = older_m;
  pair.current.path_m = current_m;
  pair.current.T_odom_sensor.translation_m.x() = current_m;
  pair.T_older_current.translation_m.y() = error_m;
  return pair;
}

TEST(LoopEvidence, OneKeyframeConvincesNobodySeveralDo) {
  LoopEvidence evidence;
  int needed = 0;
  for (double way_m = 0.0; way_m < 5.0; way_m += 0.5) {
    const PlacePair pair = pair_at(10.0 + way_m, 60.0 + way_m);
    evidence.speak_for(pair);
    ++needed;
    if (evidence.convincing(pair)) break;
  }
  EXPECT_EQ(needed, 4);
}

TEST(LoopEvidence, ASensorThatStandsStillConvincesNobody) {
  LoopEvidence evidence;
  for (int i = 0; i < 20; ++i) evidence.speak_for(pair_at(10.0, 60.0));
  EXPECT_FALSE(evidence.convincing(pair_at(10.0, 60.0)));
}

TEST(LoopEvidence, WhatContradictsOneAnotherDoesNotAddUp) {
  LoopEvidence evidence;
  for (int i = 0; i < 10; ++i) {
    const PlacePair pair = pair_at(10.0 + 0.5 * i, 60.0 + 0.5 * i, i % 2 == 0 ? 0.0 : 2.0);
    evidence.speak_for(pair);
    EXPECT_FALSE(evidence.convincing(pair));
  }
}

TEST(LoopEvidence, ContradictionsWeighAgainstWhatFollows) {
  LoopEvidence evidence;
  for (int i = 0; i < 3; ++i) evidence.speak_against(pair_at(10.0 + 0.5 * i, 60.0 + 0.5 * i));
  int needed = 0;
  for (double way_m = 1.5; way_m < 10.0; way_m += 0.5) {
    const PlacePair pair = pair_at(10.0 + way_m, 60.0 + way_m);
    evidence.speak_for(pair);
    ++needed;
    if (evidence.convincing(pair)) break;
  }
  EXPECT_EQ(needed, 7);
}

TEST(LoopEvidence, ABelievedLoopForeseesThoseNearIt) {
  LoopEvidence evidence;
  EXPECT_EQ(evidence.foreseen(pair_at(12.0, 62.0)), std::nullopt);
  evidence.believe(pair_at(10.0, 60.0));
  EXPECT_EQ(evidence.foreseen(pair_at(12.0, 62.0)), true);
  EXPECT_EQ(evidence.foreseen(pair_at(12.0, 62.0, 3.0)), false);
  EXPECT_EQ(evidence.foreseen(pair_at(50.0, 100.0)), std::nullopt);
}

TEST(LoopEvidence, OlderKeyframesJoinedByALoopAreOnePlaceWhateverOdometrySays) {
  // By odometry the first and the second time lie 50 m apart.
  LoopEvidence evidence;
  const PlacePair first_time = pair_at(10.0, 110.0);
  const PlacePair second_time = pair_at(60.0, 110.0);
  EXPECT_FALSE(evidence.agree(first_time, second_time));
  evidence.believe(pair_at(12.0, 62.0));
  EXPECT_TRUE(evidence.agree(first_time, second_time));
  EXPECT_TRUE(evidence.agree(second_time, first_time));
  EXPECT_FALSE(evidence.agree(first_time, pair_at(60.0, 110.0, 3.0)));
}

TEST(LoopEvidence, PairsOfOtherSegmentsNeverAgree) {
  PlacePair other = pair_at(10.0, 60.0);
  other.older.segment = 1;
  EXPECT_FALSE(LoopEvidence().agree(pair_at(10.0, 60.0), other));
}

}  // namespace
}  // namespace glint::slam
