// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/loop_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "slam/loops/test_gallery.hpp"

namespace glint::slam {
namespace {

/// Walks a gallery and asks for loops; odometry drifts by what it is told.
struct Walk {
  explicit Walk(int galleries = 1, int pictured = 1, bool thins = true)
      : gallery(galleries, pictured),
        detector(std::make_shared<const Vocabulary>(gallery.vocabulary()), true, thins) {}

  /// From one place to another of a gallery, looking the way one goes.
  void go(double from_m, double to_m, int at_gallery = 0) {
    const double ahead = to_m > from_m ? 1.0 : -1.0;
    for (double x_m = from_m; (to_m - x_m) * ahead > 0; x_m += 0.5 * ahead) {
      see(gallery_pose(x_m, 0.1, ahead > 0 ? 0.0 : M_PI, at_gallery));
    }
  }

  void see(const Pose& truth) {
    Keyframe keyframe = gallery.look(truth, truths.size(), time_s);
    keyframe.estimate.T_odom_sensor = drift * truth;
    keyframe.estimate.segment = segment;
    truths.push_back(truth);
    time_s += 0.5;
    for (const LoopEdge& edge : detector.add(keyframe)) edges.push_back(edge);
    if (const auto& seen = detector.seen_before()) {
      ++known;
      const Pose there = truths[seen->keyframe].inverse() * truth;
      worst_known_m = std::max(worst_known_m,
                               (there.translation_m - seen->T_older_current.translation_m).norm());
    }
    for (const LoopCandidate& candidate : detector.candidates()) candidates.push_back(candidate);
  }

  /// Largest error of the edges.
  [[nodiscard]] double worst() const { return worst_error(edges, truths); }

  TestGallery gallery;
  LoopDetector detector;
  Pose drift;
  double time_s = 0.0;
  std::uint32_t segment = 0;
  std::vector<Pose> truths;
  std::vector<LoopEdge> edges;
  std::vector<LoopCandidate> candidates;
  int known = 0;  ///< Keyframes that an older one shows too.
  double worst_known_m = 0.0;
};

TEST(LoopDetector, FindsTheWayBackWhateverTheOdometrySays) {
  Walk walk;
  walk.go(2.0, 28.0);
  EXPECT_TRUE(walk.edges.empty());
  walk.drift.rotation = so3_exp({0.0, 0.0, 0.35});
  walk.drift.translation_m = {8.0, -6.0, 0.0};
  walk.go(28.0, 2.0);
  EXPECT_GE(walk.edges.size(), 5U);
  EXPECT_LT(walk.worst(), 0.06);
  for (const LoopEdge& edge : walk.edges) {
    EXPECT_LT(edge.from, edge.to);
    EXPECT_TRUE(edge.covariance.allFinite());
    EXPECT_GT(edge.covariance.diagonal().minCoeff(), 0.0);
  }
}

TEST(LoopDetector, KeyframesThatBoreALoopOutBecomeLoopsWithIt) {
  Walk walk;
  walk.go(2.0, 28.0);
  walk.drift.translation_m = {3.0, 2.0, 0.0};
  double x_m = 28.0;
  for (; x_m > 2.0 && walk.edges.empty(); x_m -= 0.5) walk.see(gallery_pose(x_m, 0.1, M_PI, 0));
  ASSERT_GE(walk.edges.size(), 2U);
  const std::uint64_t latest = walk.truths.size() - 1;
  EXPECT_EQ(walk.edges.front().to, latest) << "the loop itself comes first";
  std::uint64_t before = 0;
  for (std::size_t i = 1; i < walk.edges.size(); ++i) {
    EXPECT_LT(walk.edges[i].to, latest);
    EXPECT_GT(walk.edges[i].to, before);
    before = walk.edges[i].to;
  }
  EXPECT_LT(walk.worst(), 0.06);
  const auto accepted = std::ranges::count(walk.candidates, true, &LoopCandidate::accepted);
  EXPECT_EQ(static_cast<std::size_t>(accepted), walk.edges.size()) << "each with its figures";
}

TEST(LoopDetector, WhatWasJustSeenIsNoLoop) {
  Walk walk;
  walk.go(2.0, 12.0);
  walk.go(12.0, 2.0);
  EXPECT_TRUE(walk.edges.empty()) << "20 s have passed";
  EXPECT_TRUE(walk.candidates.empty());
}

TEST(LoopDetector, RefusesAPlaceOfTheSameMakeWithOtherPictures) {
  Walk walk(2, 1);
  walk.go(2.0, 28.0, 0);
  // By odometry the second gallery might be the first, ten metres off.
  walk.drift.translation_m = {0.0, 10.0 - TestGallery::kApart_m, 0.0};
  walk.go(2.0, 28.0, 1);
  EXPECT_TRUE(walk.edges.empty());
  EXPECT_THAT(walk.candidates, ::testing::Contains(::testing::Field(
                                   &LoopCandidate::reason, "the places show different things")));
}

TEST(LoopDetector, RefusesWhatNoOdometryErrsBy) {
  Walk walk(2, 0);
  walk.go(2.0, 28.0, 0);
  walk.go(2.0, 28.0, 1);
  EXPECT_TRUE(walk.edges.empty());
  EXPECT_THAT(walk.candidates, ::testing::Contains(::testing::Field(
                                   &LoopCandidate::reason, "odometry does not err that far")));
}

TEST(LoopDetector, JoinsSegmentsAtOnce) {
  Walk walk;
  walk.go(2.0, 12.0);
  walk.segment = 1;
  walk.drift.rotation = so3_exp({0.0, 0.0, 2.0});
  walk.drift.translation_m = {100.0, 50.0, 0.0};
  walk.go(4.0, 10.0);
  ASSERT_FALSE(walk.edges.empty());
  EXPECT_LT(walk.worst(), 0.06);
}

TEST(LoopDetector, RepeatsBitForBit) {
  const auto run = [] {
    Walk walk;
    walk.go(2.0, 28.0);
    walk.go(28.0, 6.0);
    return walk.edges;
  };
  const auto first = run();
  const auto second = run();
  ASSERT_FALSE(first.empty());
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].from, second[i].from);
    EXPECT_EQ(first[i].T_from_to.translation_m, second[i].T_from_to.translation_m);
    EXPECT_EQ(first[i].covariance, second[i].covariance);
  }
}

TEST(LoopDetector, WhatIsPassedAgainAndAgainIsKnown) {
  Walk walk;
  walk.go(2.0, 28.0);
  EXPECT_EQ(walk.known, 0);
  for (int pass = 0; pass < 3; ++pass) {
    walk.go(28.0, 2.0);
    walk.go(2.0, 28.0);
  }
  const int known_before = walk.known;
  const std::size_t bytes_before = walk.detector.bytes();
  const std::size_t edges_before = walk.edges.size();
  for (int pass = 0; pass < 10; ++pass) {
    walk.go(28.0, 2.0);
    walk.go(2.0, 28.0);
  }
  // 1040 keyframes, of which 250 wait to be forgotten; each would take 20 kB.
  EXPECT_GT(walk.known - known_before, 900);
  EXPECT_LT(walk.detector.bytes(), bytes_before + 400 * 20'000);
  const auto added = walk.edges.size() - edges_before;
  EXPECT_LT(added, 20U * 26U / 3U) << "one a metre would say the same again and again";
  EXPECT_GT(added, 20U * 2U) << "still held to the map";
  EXPECT_LT(walk.worst(), 0.06);
  EXPECT_LT(walk.worst_known_m, 0.1);
}

TEST(LoopDetector, WhereAnotherPictureHangsIsNotKnown) {
  Walk walk(2, 1);
  walk.go(2.0, 28.0, 0);
  walk.go(28.0, 2.0, 0);
  walk.go(2.0, 15.0, 0);
  const int known = walk.known;
  ASSERT_GT(known, 10);
  // From here on the other gallery is taken for this one.
  walk.drift.translation_m = {0.0, -TestGallery::kApart_m, 0.0};
  walk.go(15.0, 28.0, 1);
  EXPECT_LT(walk.known - known, 5);
}

TEST(LoopDetector, WhoKeepsAllIsToldOfNone) {
  Walk walk(1, 1, false);
  walk.go(2.0, 28.0);
  walk.go(28.0, 2.0);
  walk.go(2.0, 28.0);
  EXPECT_FALSE(walk.edges.empty());
  EXPECT_EQ(walk.known, 0);
}

TEST(LoopDetector, KeyframesWithoutKeypointsAreNoPlace) {
  LoopDetector detector(default_vocabulary());
  for (std::uint64_t id = 0; id < 100; ++id) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.estimate.stamp = SensorTime{static_cast<std::int64_t>(id) * kNsPerSecond};
    keyframe.estimate.T_odom_sensor.translation_m = {static_cast<double>(id), 0.0, 0.0};
    EXPECT_TRUE(detector.add(keyframe).empty());
    EXPECT_TRUE(detector.candidates().empty());
  }
}

}  // namespace
}  // namespace glint::slam
