// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// A large map of an earlier session: the place in it is found before all of it is read.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <string>
#include <vector>

#include "slam/backend.hpp"
#include "slam/store/database.hpp"
#include "slam/store/session_reader.hpp"
#include "slam/test_gallery_robot.hpp"

namespace glint::slam {
namespace {

class BackendRestore : public test::GalleryRobot {
 protected:
  static constexpr std::uint64_t kMapped = 260;

  BackendRestore() {
    loops_.remember = [this](const Keyframe& keyframe) { remembered_.push_back(keyframe.id); };
  }

  /// Walks ahead through the gallery with small steps, odometry as the map.
  void make_map() {
    Backend backend(config_, map_file_, {}, loops_);
    while (next_ < kMapped) {
      backend.process(seen(gallery_pose(2.0 + 0.07 * static_cast<double>(next_), 0.1, 0.0), {}));
    }
    backend.finish();
    remembered_.clear();
    next_ = 0;
  }
  Keyframe come_back(Backend& backend, int k) {
    const Keyframe keyframe = seen(back_at(k), T_odom_world_);
    backend.process(keyframe);
    return keyframe;
  }
  /// Comes back until its place is told, which is before the map is whole.
  int come_back_until_placed(Backend& backend) {
    int k = 0;
    while (k < 8 && !backend.correction().placed) come_back(backend, k++);
    EXPECT_TRUE(backend.correction().placed);
    EXPECT_LT(backend.restored(), 1.0);
    return k;
  }

  std::vector<std::uint64_t> remembered_;
};

TEST_F(BackendRestore, TheMapComesBackSomeKeyframesAtATime) {
  make_map();
  Backend backend(config_, later_file_, {}, loops_, map_file_);
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
  Backend backend(config_, later_file_, {}, loops_, map_file_);
  int k = come_back_until_placed(backend);
  EXPECT_EQ(backend.searching_s(), 0.0);
  EXPECT_EQ(backend.snapshot()->keyframe_count, kMapped);
  EXPECT_EQ(backend.session_file(), "");
  Keyframe last;
  while (backend.restored() < 1.0) {
    last = come_back(backend, k++);
    EXPECT_LT(error_m(backend, last, back_at(k - 1)), 0.08);
  }
  EXPECT_EQ(backend.session_file(), later_file_);
  EXPECT_EQ(backend.snapshot()->keyframe_count, kMapped + next_);
  last = come_back(backend, k);
  EXPECT_LT(error_m(backend, last, back_at(k)), 0.08);
  backend.finish();
  EXPECT_EQ(SessionReader(later_file_).keyframe_count(), kMapped + next_);
}

TEST_F(BackendRestore, AnEndBeforeTheMapIsWholeLosesNothing) {
  make_map();
  std::uint64_t before = kMapped;
  for (const Ending ending : {Ending::kSoon, Ending::kWhole}) {
    next_ = 0;
    Backend backend(config_, map_file_, {}, loops_, map_file_);
    const auto points = backend.snapshot()->point_count;
    come_back_until_placed(backend);
    remembered_.clear();
    backend.finish(ending);
    EXPECT_EQ(SessionReader(map_file_).keyframe_count(), before + next_);
    EXPECT_EQ(SessionReader(map_file_).segments().back().keyframes, next_);
    EXPECT_FALSE(SessionReader(map_file_).loop_edges().empty());
    before += next_;
    if (ending == Ending::kSoon) {
      EXPECT_LE(remembered_.size(), next_) << "the rest of the map is not read for it";
    } else {
      EXPECT_EQ(backend.restored(), 1.0);
      EXPECT_GT(backend.snapshot()->point_count, points);
    }
  }
}

TEST_F(BackendRestore, TheMapIsWholeAtTheEndWhereTheSensorWasNotFound) {
  make_map();
  Backend backend(config_, later_file_, {}, loops_, map_file_);
  backend.finish();
  EXPECT_EQ(backend.restored(), 1.0);
  EXPECT_EQ(remembered_.size(), kMapped);
}

TEST_F(BackendRestore, TrackingThatRestartsMeanwhileIsLookedForAnew) {
  make_map();
  Backend backend(config_, later_file_, {}, loops_, map_file_);
  come_back_until_placed(backend);
  const auto epoch = backend.correction().epoch;
  Keyframe last;
  for (int i = 0; i < 8; ++i) {
    last = seen(back_at(12 + i), {}, 1);
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

TEST_F(BackendRestore, WhatProvesDamagedAfterTheLoadIsSkippedAndCounted) {
  make_map();
  {
    Database database(map_file_.string(), SQLITE_OPEN_READWRITE);
    database.run("UPDATE clouds SET points = x'00' WHERE keyframe IN (150, 151, 259)");
  }
  Backend backend(config_, later_file_, {}, loops_, map_file_);
  while (backend.restore_more()) {
  }
  EXPECT_EQ(backend.restored(), 1.0);
  EXPECT_EQ(backend.unreadable_keyframes(), 3U);
  EXPECT_EQ(remembered_.size(), kMapped - 3);
  Keyframe last;
  for (int k = 0; k < 8; ++k) last = come_back(backend, k);
  ASSERT_TRUE(backend.correction().placed);
  EXPECT_LT(error_m(backend, last, back_at(7)), 0.08);
  EXPECT_EQ(backend.snapshot()->keyframe_count, kMapped + next_);
}

TEST_F(BackendRestore, WhatIsDamagedAmongTheFirstRefusesTheLoad) {
  make_map();
  {
    Database database(map_file_.string(), SQLITE_OPEN_READWRITE);
    database.run("UPDATE clouds SET points = x'00' WHERE keyframe = 5");
  }
  const std::string why =
      test::refusal_of([&] { Backend backend(config_, later_file_, {}, loops_, map_file_); });
  EXPECT_NE(why.find("the points of keyframe 5"), std::string::npos) << why;
}

TEST_F(BackendRestore, ASessionWithoutWordsIsFoundInAsWell) {
  make_map();
  {
    Database database(map_file_.string(), SQLITE_OPEN_READWRITE);
    database.run("DROP TABLE words");
  }
  Backend backend(config_, later_file_, {}, loops_, map_file_);
  for (int k = 0; k < 8; ++k) come_back(backend, k);
  EXPECT_TRUE(backend.correction().placed);
}

TEST_F(BackendRestore, WordsThatNoVocabularyHasAreNotBelieved) {
  make_map();
  {
    Database database(map_file_.string(), SQLITE_OPEN_READWRITE);
    database.run("UPDATE words SET data = x'ffffffff0000803f'");
  }
  Backend backend(config_, later_file_, {}, loops_, map_file_);
  for (int k = 0; k < 8; ++k) come_back(backend, k);
  EXPECT_TRUE(backend.correction().placed);
}

}  // namespace
}  // namespace glint::slam
