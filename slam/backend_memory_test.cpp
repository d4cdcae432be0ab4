// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <tuple>

#include "slam/backend.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::slam {
namespace {

constexpr std::uint64_t kKeyframes = 200;

Pose pose_of(std::uint64_t k) {
  return {Eigen::Quaterniond::Identity(), {4.0 * static_cast<double>(k), 0.0, 0.0}};
}

/// A sensor on a straight road, with 3000 points around it each time.
Keyframe on_road(std::uint64_t k) {
  Keyframe keyframe;
  keyframe.id = k;
  keyframe.estimate.sequence = 5 * k;
  keyframe.estimate.stamp.ns = static_cast<std::int64_t>(k) * 500'000'000;
  keyframe.estimate.T_odom_sensor = pose_of(k);
  std::mt19937 random(static_cast<std::uint32_t>(k));
  std::uniform_real_distribution<float> within(-15.0F, 15.0F);
  for (int i = 0; i < 3000; ++i) {
    keyframe.points.push_back({within(random), within(random), 0.1F * within(random), 10.0F});
  }
  return keyframe;
}

/// The last keyframe sees the first one, two metres from where odometry has it.
LoopSource loop_at_the_end() {
  LoopSource source;
  source.search = [](const Keyframe& keyframe) {
    LoopSearch found;
    if (keyframe.id + 1 != kKeyframes) return found;
    LoopEdge edge{0, keyframe.id, pose_of(keyframe.id), {}};
    edge.T_from_to.translation_m += Eigen::Vector3d(1.0, 2.0, 0.5);
    edge.covariance = Eigen::Matrix<double, 6, 6>::Identity() * 1e-4;
    found.edges.push_back(edge);
    found.candidates.push_back({edge.from, edge.to, true, "", 0.9, 80, 60, 0.7, 0.02});
    return found;
  };
  return source;
}

/// What a client gets, tile by tile; the order of points in a tile follows from how it was moved.
std::vector<std::tuple<TileIndex, float, float, float>> points_of_map(const MapSnapshot& map) {
  std::vector<std::tuple<TileIndex, float, float, float>> points;
  for (const auto& tile : map.tiles) {
    for (const MapPoint& p : tile->points) points.emplace_back(tile->index, p.x_m, p.y_m, p.z_m);
  }
  std::ranges::sort(points);
  return points;
}

class BackendMemory : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(directory_); }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  static SlamConfig config(int memory_mb) {
    SlamConfig config;
    config.map_voxel_m = 0.2;
    config.moving_objects = false;
    config.map_memory_mb = memory_mb;
    return config;
  }

  const std::filesystem::path directory_ =
      std::filesystem::temp_directory_path() / ("glint-memory-" + std::to_string(getpid()));
};

TEST_F(BackendMemory, TilesLongUnseenGoToTheDiskAndTheMapIsTheSame) {
  Backend free(config(0), {}, {}, loop_at_the_end());
  Backend bounded(config(10), directory_ / "session.glint", {}, loop_at_the_end());
  std::size_t most_bytes = 0;
  for (std::uint64_t k = 0; k < kKeyframes; ++k) {
    free.process(on_road(k));
    most_bytes = std::max(most_bytes, free.memory().bytes);
    bounded.process(on_road(k));
    EXPECT_LT(bounded.memory().bytes, 10'000'000U) << k;
    EXPECT_FALSE(bounded.memory().full);
    if (k + 2 == kKeyframes) {
      EXPECT_EQ(points_of_map(*bounded.snapshot()), points_of_map(*free.snapshot()));
    }
  }
  EXPECT_GT(most_bytes, 20'000'000U) << "the limit is worth setting";
  EXPECT_EQ(free.memory().disk_bytes, 0U);
  EXPECT_GT(bounded.memory().disk_bytes, 5'000'000U);
  ASSERT_EQ(bounded.correction().epoch, 1U) << "the loop moved the map";
  EXPECT_EQ(points_of_map(*bounded.snapshot()), points_of_map(*free.snapshot()));
  EXPECT_EQ(bounded.snapshot()->point_count, free.snapshot()->point_count);
}

TEST_F(BackendMemory, WhatIsSeenAgainComesBackAndIsAddedTo) {
  Backend free(config(0));
  Backend bounded(config(10));
  const auto process = [&](std::uint64_t id, std::uint64_t at) {
    Keyframe keyframe = on_road(at);
    keyframe.id = id;
    keyframe.estimate.sequence = 5 * id;
    for (MapPoint& point : keyframe.points) point.x_m += 0.3F * static_cast<float>(id % 2);
    free.process(keyframe);
    bounded.process(keyframe);
  };
  for (std::uint64_t k = 0; k < kKeyframes; ++k) process(k, k);
  for (std::uint64_t k = 0; k < kKeyframes; ++k) process(kKeyframes + k, kKeyframes - k);
  const auto of_free = static_cast<double>(free.snapshot()->point_count);
  // A float's last bit may say otherwise which voxel a point lies in.
  EXPECT_NEAR(static_cast<double>(bounded.snapshot()->point_count), of_free, 1e-3 * of_free);
  EXPECT_EQ(bounded.snapshot()->tiles.size(), free.snapshot()->tiles.size());
  EXPECT_LT(bounded.memory().bytes, 10'000'000U);
}

TEST_F(BackendMemory, WhereTheDiskTakesNothingTheMapStopsGrowingAndTheGraphGoesOn) {
  const char* const before = std::getenv("TMPDIR");
  const std::string restored = before == nullptr ? "" : before;
  setenv("TMPDIR", "/nowhere/at/all", 1);
  Backend backend(config(10));
  for (std::uint64_t k = 0; k < kKeyframes; ++k) backend.process(on_road(k));
  before == nullptr ? unsetenv("TMPDIR") : setenv("TMPDIR", restored.c_str(), 1);
  EXPECT_TRUE(backend.memory().full);
  EXPECT_LT(backend.memory().bytes, 11'000'000U);
  EXPECT_GT(backend.snapshot()->points_refused, 100'000U);
  EXPECT_EQ(backend.snapshot()->keyframe_count, kKeyframes);
}

TEST_F(BackendMemory, AMapThatIsGoneOnWithIsLoadedWithinTheLimit) {
  {
    Backend backend(config(0), directory_ / "earlier.glint");
    for (std::uint64_t k = 0; k < kKeyframes; ++k) backend.process(on_road(k));
  }
  Backend backend(config(10), directory_ / "later.glint", {}, {}, directory_ / "earlier.glint");
  do {
    EXPECT_LT(backend.memory().bytes, 10'000'000U);
  } while (backend.restore_more());
  EXPECT_GT(backend.memory().disk_bytes, 5'000'000U);
  EXPECT_EQ(backend.snapshot()->keyframe_count, kKeyframes);
}

}  // namespace
}  // namespace glint::slam
