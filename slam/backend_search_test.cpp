// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// A back end whose map is only read, and one that looks for the sensor anew.
#include <gtest/gtest.h>

#include "slam/backend.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/test_gallery_robot.hpp"

namespace glint::slam {
namespace {

namespace fs = std::filesystem;

class BackendSearch : public test::GalleryRobot {
 protected:
  /// Walks ahead through the gallery, odometry as the map.
  void map_gallery(Backend& backend) {
    for (double x_m = 2.0; x_m < 20.0; x_m += 0.5) {
      backend.process(seen(gallery_pose(x_m, 0.1, 0.0), {}));
    }
    backend.finish();
  }
};

TEST_F(BackendSearch, AMapThatIsOnlyReadStaysAsItIs) {
  {
    Backend backend(config_, map_file_, {}, loops_);
    map_gallery(backend);
  }
  const std::string bytes = test::read_bytes(map_file_);
  const std::uint64_t mapped = next_;
  Backend backend(config_, later_file_, {}, loops_, map_file_, MapUse::kLocalize);
  EXPECT_EQ(backend.search(), MapSearch::kMapOnlyRead);
  const auto points = backend.snapshot()->point_count;
  next_ = 0;
  for (int k = 0; k < 20; ++k) {
    const Keyframe keyframe = seen(back_at(k), T_odom_world_, 0);
    backend.process(keyframe);
    if (k > 6) {
      EXPECT_LT(error_m(backend, keyframe, back_at(k)), 0.08) << k;
    }
  }
  EXPECT_EQ(backend.search(), MapSearch::kNone);
  backend.finish();
  EXPECT_TRUE(backend.correction().placed);
  EXPECT_EQ(backend.snapshot()->keyframe_count, mapped);
  EXPECT_EQ(backend.snapshot()->point_count, points);
  EXPECT_EQ(backend.snapshot()->epoch, backend.correction().epoch);
  EXPECT_EQ(backend.session_file(), "");
  EXPECT_EQ(test::read_bytes(map_file_), bytes);
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), {}), 1) << "nothing beside it";
}

TEST_F(BackendSearch, WhatIsSeenAfterASearchThatWasAskedForIsASegmentOfItsOwn) {
  Backend backend(config_, map_file_, {}, loops_);
  map_gallery(backend);
  const std::uint64_t mapped = next_;
  const Keyframe before = seen(back_at(0), {}, 0);
  backend.process(before);
  ASSERT_TRUE(backend.search_anew());
  EXPECT_EQ(backend.search(), MapSearch::kOwnMap);
  EXPECT_FALSE(backend.correction().placed);
  // Odometry goes on, but by 3 m wrong: only the map tells.
  const Pose off{Eigen::Quaterniond::Identity(), {3.0, 0.0, 0.0}};
  Keyframe last;
  for (int k = 1; k < 8; ++k) {
    last = seen(back_at(k), off, 0);
    backend.process(last);
  }
  ASSERT_TRUE(backend.correction().placed);
  EXPECT_LT(error_m(backend, last, back_at(7)), 0.08);
  EXPECT_LT(error_m(backend, before, back_at(0)), 0.08) << "what was there stays";
  EXPECT_EQ(backend.snapshot()->keyframe_count, mapped + 8);
  backend.finish();
  EXPECT_EQ(SessionReader(map_file_).segments().size(), 2U);
  EXPECT_EQ(SessionReader(map_file_).keyframe_count(), mapped + 8);
}

TEST_F(BackendSearch, ANewSegmentOfOdometryIsLookedForInTheMapThereIs) {
  Backend backend(config_, map_file_, {}, loops_);
  backend.search_new_segments();
  map_gallery(backend);
  const std::uint64_t mapped = next_;
  Keyframe last;
  for (int k = 0; k < 8; ++k) {
    last = seen(back_at(k), T_odom_world_, 1);
    backend.process(last);
    if (k == 0) {
      EXPECT_EQ(backend.search(), MapSearch::kOwnMap);
    }
  }
  ASSERT_TRUE(backend.correction().placed);
  EXPECT_LT(error_m(backend, last, back_at(7)), 0.08);
  backend.finish();
  EXPECT_EQ(SessionReader(map_file_).segments().size(), 2U);
  EXPECT_EQ(SessionReader(map_file_).keyframe_count(), mapped + 8);
}

TEST_F(BackendSearch, WhereItIsNotFoundTheMapGoesOnAsOdometryHasIt) {
  Backend backend(config_, map_file_, {}, loops_);
  map_gallery(backend);
  const std::uint64_t mapped = next_;
  ASSERT_TRUE(backend.search_anew());
  Keyframe last;
  for (int k = 0; k < 5; ++k) {
    last = seen(back_at(k), {}, 0);
    last.features = {};
    backend.process(last);
  }
  EXPECT_FALSE(backend.correction().placed);
  EXPECT_GT(backend.searching_s(), 1.0);
  EXPECT_EQ(backend.snapshot()->keyframe_count, mapped);
  backend.go_on_unfound();
  EXPECT_TRUE(backend.correction().placed);
  EXPECT_EQ(backend.searching_s(), 0.0);
  EXPECT_EQ(backend.snapshot()->keyframe_count, mapped + 5);
  EXPECT_LT(error_m(backend, last, back_at(4)), 0.01);
  backend.finish();
  EXPECT_EQ(SessionReader(map_file_).segments().size(), 1U);
}

TEST_F(BackendSearch, WithoutAMapOrASessionThereIsNothingToLookIn) {
  Backend empty(config_, map_file_, {}, loops_);
  EXPECT_FALSE(empty.search_anew());
  Backend without(config_, {}, {}, loops_);
  map_gallery(without);
  EXPECT_FALSE(without.search_anew());
  EXPECT_TRUE(without.correction().placed);
}

}  // namespace
}  // namespace glint::slam
