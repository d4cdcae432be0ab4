// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// A large map of an earlier session: the place in it is found before all of it is read.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <tuple>
#include <vector>

#include "slam/backend.hpp"
#include "slam/loops/test_gallery.hpp"
#include "slam/store/database.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/store/test_session.hpp"

namespace glint::slam {
namespace {

namespace fs = std::filesystem;
using PointList = std::vector<std::tuple<float, float, float>>;

PointList points_of(const MapSnapshot& snapshot) {
  PointList points;
  for (const auto& tile : snapshot.tiles) {
    for (const MapPoint& point : tile->points) points.emplace_back(point.x_m, point.y_m, point.z_m);
  }
  std::ranges::sort(points);
  return points;
}

class BackendRestore : public test::InDirectory {
 protected:
  static constexpr std::uint64_t kMapped = 260;

  BackendRestore() {
    config_.map_voxel_m = 0.2;
    loops_.search = [](const Keyframe&) { return LoopSearch{}; };
    loops_.remember = [this](const Keyframe& keyframe) { remembered_.push_back(keyframe.id); };
  }

  /// Walks ahead through the gallery with small steps, odometry as the map.
  void make_map() {
    Backend backend(config_, file_, {}, loops_);
    for (; next_ < kMapped; ++next_) {
      backend.process(seen(gallery_pose(2.0 + 0.07 * static_cast<double>(next_), 0.1, 0.0), {}));
    }
    backend.finish();
    whole_ = points_of(*backend.snapshot());
    remembered_.clear();
    next_ = 0;
  }
  Keyframe seen(const Pose& truth, const Pose& T_odom_world) {
    Keyframe keyframe = gallery_.look(truth, next_, 0.5 * static_cast<double>(next_));
    keyframe.estimate.sequence = 5 * next_;
    keyframe.estimate.T_odom_sensor = T_odom_world * truth;
    keyframe.edge_covariance.diagonal().setConstant(1e-6);
    return keyframe;
  }
  static Pose back_at(int k) { return gallery_pose(14.0 - 0.4 * k, -0.2, M_PI); }
  Keyframe come_back(Backend& backend, int k) {
    const Keyframe keyframe = seen(back_at(k), T_odom_world_);
    ++next_;
    backend.process(keyframe);
    return keyframe;
  }
  static double error_m(const Backend& backend, const Keyframe& keyframe, const Pose& truth) {
    const OdometryEstimate& e = keyframe.estimate;
    const Pose pose =
        backend.correction().map_pose(e.segment, static_cast<double>(e.sequence), e.T_odom_sensor);
    return (pose.translation_m - truth.translation_m).norm();
  }

  SlamConfig config_;
  LoopSource loops_;
  TestGallery gallery_;
  std::uint64_t next_ = 0;
  PointList whole_;
  std::vector<std::uint64_t> remembered_;
  const fs::path file_ = directory_ / "map.glint";
  const fs::path later_ = directory_ / "later.glint";
  const Pose T_odom_world_{so3_exp({0.0, 0.0, 1.0}), {50.0, -20.0, 3.0}};
};

TEST_F(BackendRestore, TheMapComesBackSomeKeyframesAtATime) {
  make_map();
  Backend backend(config_, later_, {}, loops_, file_);
  EXPECT_EQ(backend.snapshot()->keyframe_count, kMapped) << "the graph is there at once";
  EXPECT_LT(backend.restored(), 0.5);
  const auto first = backend.snapshot()->point_count;
  double before = backend.restored();
  while (backend.restore_more()) {
    EXPECT_GT(backend.restored(), before);
    before = backend.restored();
  }
  EXPECT_EQ(backend.restored(), 1.0);
  EXPECT_GT(backend.snapshot()->point_count, first);
  EXPECT_EQ(remembered_.size(), kMapped);
  EXPECT_TRUE(std::ranges::is_sorted(remembered_));
  EXPECT_FALSE(backend.correction().placed);
}

TEST_F(BackendRestore, ThePlaceIsToldBeforeTheMapIsWholeAndWhatIsBuiltWaits) {
  make_map();
  Backend backend(config_, later_, {}, loops_, file_);
  Keyframe last;
  int k = 0;
  for (; k < 8 && !backend.correction().placed; ++k) last = come_back(backend, k);
  ASSERT_TRUE(backend.correction().placed);
  ASSERT_LT(backend.restored(), 1.0);
  EXPECT_LT(error_m(backend, last, back_at(k - 1)), 0.08);
  EXPECT_EQ(backend.searching_s(), 0.0);
  EXPECT_EQ(backend.snapshot()->keyframe_count, kMapped);
  EXPECT_EQ(backend.session_file(), "");
  while (backend.restored() < 1.0) {
    last = come_back(backend, k++);
    EXPECT_LT(error_m(backend, last, back_at(k - 1)), 0.08);
  }
  EXPECT_EQ(backend.session_file(), later_);
  EXPECT_EQ(backend.snapshot()->keyframe_count, kMapped + next_);
  last = come_back(backend, k);
  EXPECT_LT(error_m(backend, last, back_at(k)), 0.08);
  backend.finish();
  EXPECT_EQ(SessionReader(later_).keyframe_count(), kMapped + next_);
}

TEST_F(BackendRestore, AnEndBeforeTheMapIsWholeLosesNothing) {
  make_map();
  {
    Backend backend(config_, file_, {}, loops_, file_);
    for (int k = 0; k < 8 && !backend.correction().placed; ++k) come_back(backend, k);
    ASSERT_TRUE(backend.correction().placed);
    ASSERT_LT(backend.restored(), 1.0);
    backend.finish();
  }
  EXPECT_EQ(SessionReader(file_).keyframe_count(), kMapped + next_);
}

TEST_F(BackendRestore, TrackingThatRestartsMeanwhileIsLookedForAnew) {
  make_map();
  Backend backend(config_, later_, {}, loops_, file_);
  int k = 0;
  for (; k < 8 && !backend.correction().placed; ++k) come_back(backend, k);
  ASSERT_TRUE(backend.correction().placed);
  ASSERT_LT(backend.restored(), 1.0);
  const auto epoch = backend.correction().epoch;
  Keyframe last;
  for (int i = 0; i < 8; ++i) {
    last = seen(back_at(12 + i), {});
    last.estimate.segment = 1;
    ++next_;
    backend.process(last);
    if (i == 0) {
      EXPECT_FALSE(backend.correction().placed);
    }
  }
  while (backend.restore_more()) {
  }
  ASSERT_TRUE(backend.correction().placed);
  EXPECT_GT(backend.correction().epoch, epoch);
  EXPECT_LT(error_m(backend, last, back_at(19)), 0.08);
}

TEST_F(BackendRestore, ASessionWithoutWordsIsFoundInAsWell) {
  make_map();
  {
    Database database(file_.string(), SQLITE_OPEN_READWRITE);
    database.run("DROP TABLE words");
  }
  Backend backend(config_, later_, {}, loops_, file_);
  for (int k = 0; k < 8; ++k) come_back(backend, k);
  EXPECT_TRUE(backend.correction().placed);
}

TEST_F(BackendRestore, WordsThatNoVocabularyHasAreNotBelieved) {
  make_map();
  {
    Database database(file_.string(), SQLITE_OPEN_READWRITE);
    database.run("UPDATE words SET data = x'ffffffff0000803f'");
  }
  Backend backend(config_, later_, {}, loops_, file_);
  for (int k = 0; k < 8; ++k) come_back(backend, k);
  EXPECT_TRUE(backend.correction().placed);
}

TEST_F(BackendRestore, WhatMovedIsNotInTheSessionAndTheMapComesBackAsItWas) {
  config_.moving_objects = true;
  make_map();
  EXPECT_EQ(SessionReader(file_).meta("moving_objects"), "removed");
  Backend backend(config_, later_, {}, loops_, file_);
  while (backend.restore_more()) {
  }
  // The session keeps points to a centimetre.
  const auto count = static_cast<double>(whole_.size());
  EXPECT_NEAR(static_cast<double>(backend.snapshot()->point_count), count, 0.05 * count);
}

}  // namespace
}  // namespace glint::slam
