// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "driver/core/error.hpp"
#include "slam/backend.hpp"
#include "slam/loops/test_gallery.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::slam {
namespace {

/// A session of a walk through a gallery, and a sensor that wakes up in it later.
class BackendLoad : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(directory_);
    config_.map_voxel_m = 0.2;
    Backend backend(config_, earlier_);
    for (double x_m = 2.0; x_m < 20.0; x_m += 0.5) {
      const Pose truth = gallery_pose(x_m, 0.1, 0.0);
      Keyframe keyframe = gallery_.look(truth, walked_, 0.5 * static_cast<double>(walked_));
      keyframe.estimate.sequence = 5 * walked_++;
      keyframe.estimate.segment = 0;
      backend.process(keyframe);
    }
    backend.finish();
    points_ = static_cast<double>(backend.snapshot()->point_count);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  /// The k-th keyframe after waking up at 12 m, looking back; numbers begin anew, and so does the
  /// odometry.
  Keyframe awake(std::uint64_t k, bool probe = false) {
    const Pose truth = truth_of(k);
    Keyframe keyframe = gallery_.look(truth, k, 1000.0 + 0.5 * static_cast<double>(k));
    keyframe.estimate.T_odom_sensor = truth_of(0).inverse() * truth;
    keyframe.estimate.sequence = 5 * k;
    keyframe.probe = probe;
    return keyframe;
  }
  static Pose truth_of(std::uint64_t k) {
    return gallery_pose(12.0 - 0.5 * static_cast<double>(k), -0.2, M_PI);
  }
  /// By how much the map pose of keyframe `k` is off, m.
  double error_m(const MapCorrection& correction, std::uint64_t k) {
    const OdometryEstimate estimate = awake(k).estimate;
    // The map's frame is that of its first keyframe's odometry, which was the world's.
    const Pose pose =
        correction.map_pose(0, static_cast<double>(estimate.sequence), estimate.T_odom_sensor);
    return (pose.translation_m - truth_of(k).translation_m).norm();
  }

  const std::filesystem::path directory_ =
      std::filesystem::temp_directory_path() / ("glint-load-" + std::to_string(getpid()));
  const std::filesystem::path earlier_ = directory_ / "earlier.glint";
  const std::filesystem::path later_ = directory_ / "later.glint";
  SlamConfig config_;
  TestGallery gallery_;
  std::uint64_t walked_ = 0;
  double points_ = 0.0;
};

TEST_F(BackendLoad, TheSensorIsFoundInTheMapAndGoesOnInItsFrame) {
  Backend backend(config_, later_, {}, {}, earlier_);
  EXPECT_FALSE(backend.correction().placed);
  EXPECT_EQ(backend.snapshot()->keyframe_count, walked_);
  // The session has rounded points.
  EXPECT_NEAR(static_cast<double>(backend.snapshot()->point_count), points_, 0.01 * points_);
  std::uint64_t k = 0;
  for (; k < 10 && !backend.correction().placed; ++k) backend.process(awake(k));
  ASSERT_TRUE(backend.correction().placed);
  EXPECT_GT(backend.correction().epoch, 1U);
  for (std::uint64_t i = 0; i < k; ++i) EXPECT_LT(error_m(backend.correction(), i), 0.08) << i;
  EXPECT_EQ(backend.snapshot()->keyframe_count, walked_ + k) << "those held back are in the map";
  EXPECT_GE(backend.loops_accepted(), 1U);
  for (; k < 14; ++k) backend.process(awake(k));
  EXPECT_LT(error_m(backend.correction(), 13), 0.08);
  EXPECT_EQ(backend.snapshot()->keyframe_count, walked_ + 14);
}

TEST_F(BackendLoad, TheNewSessionHoldsBothAndTheEarlierOneIsLeftAlone) {
  const auto bytes_before = std::filesystem::file_size(earlier_);
  {
    Backend backend(config_, later_, {}, {}, earlier_);
    EXPECT_EQ(backend.session_file(), "");
    EXPECT_FALSE(std::filesystem::exists(later_));
    for (std::uint64_t k = 0; k < 8; ++k) backend.process(awake(k));
    EXPECT_EQ(backend.session_file(), later_);
    backend.finish();
    EXPECT_EQ(backend.store_failures(), 0U) << backend.store_error();
  }
  EXPECT_EQ(std::filesystem::file_size(earlier_), bytes_before);
  EXPECT_EQ(SessionReader(earlier_).keyframe_count(), walked_);
  const SessionReader later(later_);
  const auto poses = later.poses();
  ASSERT_EQ(poses.size(), walked_ + 8);
  EXPECT_EQ(later.segments().size(), 2U);
  EXPECT_FALSE(later.loop_edges().empty());
  for (std::uint64_t k = 0; k < 8; ++k) {
    const Pose error = truth_of(k).inverse() * poses[walked_ + k].T_map_sensor;
    EXPECT_LT(error.translation_m.norm(), 0.08) << k;
    EXPECT_EQ(poses[walked_ + k].segment, 1U);
  }
}

TEST_F(BackendLoad, ASessionMayGoOnInItsOwnFileTimeAndAgain) {
  for (std::uint64_t run = 1; run <= 3; ++run) {
    Backend backend(config_, earlier_, {}, {}, earlier_);
    for (std::uint64_t k = 0; k < 6; ++k) backend.process(awake(k));
    ASSERT_TRUE(backend.correction().placed) << run;
    EXPECT_LT(error_m(backend.correction(), 5), 0.08) << run;
    backend.finish();
    EXPECT_EQ(SessionReader(earlier_).keyframe_count(), walked_ + 6 * run);
    EXPECT_EQ(SessionReader(earlier_).segments().size(), 1 + run);
  }
}

TEST_F(BackendLoad, ARobotAtRestIsFoundByProbesThatAreNotKept) {
  Backend backend(config_, later_, {}, {}, earlier_);
  backend.process(awake(0));
  for (std::uint64_t i = 0; i < 8 && !backend.correction().placed; ++i) {
    Keyframe probe = awake(0, true);
    probe.id = 1;
    probe.estimate.sequence = i + 1;
    backend.process(probe);
  }
  ASSERT_TRUE(backend.correction().placed);
  EXPECT_EQ(backend.snapshot()->keyframe_count, walked_ + 1);
  EXPECT_LT(error_m(backend.correction(), 0), 0.08);
}

TEST_F(BackendLoad, ElsewhereItSaysSoAndWhatWasHeldBackMakesAnotherMap) {
  Backend backend(config_, later_, {}, {}, earlier_);
  const std::size_t points = backend.snapshot()->point_count;
  for (std::uint64_t k = 0; k < 20; ++k) {
    Keyframe keyframe = awake(k);
    keyframe.features.clear();  // It sees nothing that it knows.
    backend.process(keyframe);
  }
  EXPECT_FALSE(backend.correction().placed);
  EXPECT_NEAR(backend.searching_s(), 9.5, 1e-6);
  EXPECT_FALSE(std::filesystem::exists(later_));
  EXPECT_EQ(backend.snapshot()->point_count, points) << "the map is not touched";

  const std::vector<Keyframe> waiting = backend.give_up_search();
  ASSERT_EQ(waiting.size(), 20U);
  Backend another(config_, later_);
  for (const Keyframe& keyframe : waiting) another.process(keyframe);
  another.finish();
  const auto poses = SessionReader(later_).poses();
  ASSERT_EQ(poses.size(), 20U);
  EXPECT_EQ(poses.front().id, 0U);
  EXPECT_EQ(poses.front().segment, 0U);
}

TEST_F(BackendLoad, WhereTheEarlierSessionIsGoneTheMapGoesOnWithoutOneAndSaysSo) {
  Backend backend(config_, later_, {}, {}, earlier_);
  std::filesystem::remove(earlier_);
  for (std::uint64_t k = 0; k < 8; ++k) backend.process(awake(k));
  ASSERT_TRUE(backend.correction().placed);
  EXPECT_LT(error_m(backend.correction(), 7), 0.08);
  EXPECT_EQ(backend.session_file(), "");
  EXPECT_EQ(backend.store_failures(), 1U);
  EXPECT_NE(backend.store_error().find("earlier.glint"), std::string_view::npos);
  EXPECT_EQ(backend.keyframes_not_stored(), walked_ + 8);
}

TEST_F(BackendLoad, WhatIsHeldBackIsBounded) {
  Backend backend(config_, later_, {}, {}, earlier_);
  for (std::uint64_t k = 0; k < 520; ++k) {
    Keyframe keyframe;
    keyframe.id = k;
    keyframe.estimate.stamp.ns = static_cast<std::int64_t>(k) * 500'000'000;
    backend.process(keyframe);
  }
  const std::vector<Keyframe> waiting = backend.give_up_search();
  ASSERT_EQ(waiting.size(), 500U);
  EXPECT_EQ(waiting.back().id, 519U) << "the newest are kept";
}

TEST_F(BackendLoad, AFileThatIsNoSessionIsRefused) {
  const auto file = directory_ / "text.glint";
  std::ofstream(file) << "not a session";
  EXPECT_THROW(Backend(config_, later_, {}, {}, file), InputError);
  EXPECT_FALSE(std::filesystem::exists(later_));
}

}  // namespace
}  // namespace glint::slam
