// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/merge/session_merge.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "driver/core/error.hpp"
#include "slam/backend.hpp"
#include "slam/loops/test_gallery.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::slam {
namespace {

namespace fs = std::filesystem;

/// Sessions of walks through galleries, each with an odometry of its own.
class SessionMerge : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(directory_); }
  void TearDown() override { fs::remove_all(directory_); }

  /// A walk from `from_m` to `to_m`, `y_m` beside the middle; truths in order of its keyframes.
  std::vector<Pose> walk(const std::string& name, double from_m, double to_m, double y_m,
                         int gallery = 0) {
    return record(name, way(from_m, to_m, y_m, gallery));
  }
  static std::vector<Pose> way(double from_m, double to_m, double y_m, int gallery) {
    const double step_m = to_m > from_m ? 0.5 : -0.5;
    std::vector<Pose> truths;
    for (double x_m = from_m; (to_m - x_m) * step_m > 0.0; x_m += step_m) {
      truths.push_back(gallery_pose(x_m, y_m, to_m > from_m ? 0.0 : M_PI, gallery));
    }
    return truths;
  }
  std::vector<Pose> record(const std::string& name, const std::vector<Pose>& truths) {
    config_.map_voxel_m = 0.2;
    Backend backend(config_, file(name));
    for (std::uint64_t id = 0; id < truths.size(); ++id) {
      Keyframe keyframe = gallery_.look(truths[id], id, 0.5 * static_cast<double>(id));
      keyframe.estimate.T_odom_sensor = truths.front().inverse() * truths[id];
      keyframe.estimate.sequence = 5 * id;
      keyframe.estimate.segment = 0;
      backend.process(keyframe);
    }
    backend.finish();
    return truths;
  }
  [[nodiscard]] fs::path file(const std::string& name) const {
    return directory_ / (name + ".glint");
  }
  MergeSummary merge(const std::vector<std::string>& names) {
    std::vector<fs::path> files;
    for (const std::string& name : names) files.push_back(file(name));
    return merge_sessions(files, file("merged"));
  }
  /// The largest error of the merged map's poses, whose frame is where the first walk began, m.
  double worst_m(const std::vector<std::vector<Pose>>& walks) {
    const std::vector<KeyframePose> poses = SessionReader(file("merged")).poses();
    std::size_t i = 0;
    double worst_m = 0.0;
    for (const auto& truths : walks) {
      for (const Pose& truth : truths) {
        const Pose T_map_truth = walks.front().front().inverse() * truth;
        worst_m = std::max(
            worst_m, (poses.at(i++).T_map_sensor.translation_m - T_map_truth.translation_m).norm());
      }
    }
    EXPECT_EQ(i, poses.size());
    return worst_m;
  }
  std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(directory_)) {
      all.push_back(entry.path().filename().string());
    }
    std::ranges::sort(all);
    return all;
  }

  const fs::path directory_ =
      fs::temp_directory_path() / ("glint-merge-" + std::to_string(getpid()));
  SlamConfig config_;
  TestGallery gallery_{2, 2};
};

TEST_F(SessionMerge, TwoWalksThatOverlapMakeOneMapInTheFrameOfTheFirst) {
  const auto a = walk("a", 2.0, 18.0, 0.1);
  const auto b = walk("b", 27.0, 8.0, -0.2);
  const MergeSummary summary = merge({"a", "b"});
  EXPECT_EQ(summary.sessions, 2U);
  EXPECT_EQ(summary.kept + summary.thinned, a.size() + b.size());
  EXPECT_GE(summary.joints, 3U);
  EXPECT_EQ(summary.loops, summary.joints);
  EXPECT_LT(worst_m({a, b}), 0.08);
  EXPECT_EQ(names(), (std::vector<std::string>{"a.glint", "b.glint", "merged.glint"}));
  const SessionReader merged(file("merged"));
  EXPECT_EQ(merged.segments().size(), 2U);
  EXPECT_EQ(merged.meta("map_voxel_m"), SessionReader(file("a")).meta("map_voxel_m"));
  EXPECT_EQ(merged.events().back().kind, "merge");
}

TEST_F(SessionMerge, ASecondWalkOfTheSameWayAddsPosesOnly) {
  const auto a = walk("a", 2.0, 18.0, 0.0);
  const auto b = walk("b", 2.1, 18.0, 0.1);
  const MergeSummary summary = merge({"a", "b"});
  EXPECT_GT(summary.thinned, b.size() * 3 / 4);
  EXPECT_LT(worst_m({a, b}), 0.08);
  // It is gone on with as any other is.
  Backend backend(config_, file("later"), {}, {}, file("merged"));
  EXPECT_EQ(backend.snapshot()->keyframe_count, a.size() + b.size());
  for (std::uint64_t k = 0; k < 8; ++k) {
    Keyframe keyframe = gallery_.look(gallery_pose(8.0 + 0.5 * static_cast<double>(k), 0.2, 0.0), k,
                                      1000.0 + 0.5 * static_cast<double>(k));
    keyframe.estimate.segment = 0;
    backend.process(keyframe);
  }
  EXPECT_TRUE(backend.correction().placed);
}

TEST_F(SessionMerge, ASessionMayBeTiedByOneThatIsNamedAfterIt) {
  const auto a = walk("a", 2.0, 18.0, 0.0);
  const auto c = walk("c", 2.0, 18.0, 0.0, 1);
  std::vector<Pose> both = way(3.0, 14.0, 0.1, 0);
  const std::vector<Pose> there = way(3.0, 14.0, 0.1, 1);
  both.insert(both.end(), there.begin(), there.end());
  const auto b = record("b", both);
  EXPECT_EQ(merge({"a", "c", "b"}).sessions, 3U);
  // As they were joined.
  EXPECT_LT(worst_m({a, b, c}), 0.08);
}

TEST_F(SessionMerge, SessionsOfDifferentPlacesAreRefusedAndNothingIsWritten) {
  walk("a", 2.0, 18.0, 0.0);
  walk("b", 2.0, 18.0, 0.0, 1);
  try {
    merge({"a", "b"});
    FAIL() << "merged";
  } catch (const NoOverlapError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("a.glint"), std::string::npos) << what;
    EXPECT_NE(what.find("b.glint"), std::string::npos) << what;
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"a.glint", "b.glint"}));
}

TEST_F(SessionMerge, AnEmptySessionIsBadInput) {
  walk("a", 2.0, 18.0, 0.0);
  walk("none", 2.0, 2.0, 0.0);
  EXPECT_THROW(merge({"a", "none"}), InputError);
}

}  // namespace
}  // namespace glint::slam
