// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/map.hpp"

#include <gtest/gtest.h>

namespace glint::slam {
namespace {

TEST(VoxelMap, KeepsOnePointAVoxel) {
  VoxelMap map(0.1, 1000);
  const std::vector<MapPoint> points = {
      {0.01F, 0.0F, 0.0F, 5.0F}, {0.05F, 0.02F, 0.0F, 9.0F}, {0.15F, 0.0F, 0.0F, 7.0F}};
  map.insert({}, points);
  map.insert({}, points);
  const auto snapshot = map.snapshot();
  EXPECT_EQ(snapshot->point_count, 2U);
  ASSERT_EQ(snapshot->tiles.size(), 1U);
  EXPECT_FLOAT_EQ(snapshot->tiles[0]->points[0].intensity, 5.0F);
}

TEST(VoxelMap, PointsArePlacedInTheMapFrame) {
  VoxelMap map(0.1, 1000);
  const Pose T_map_sensor{so3_exp({0, 0, M_PI / 2}), {10.0, 0.0, 1.0}};
  map.insert(T_map_sensor, std::vector<MapPoint>{{2.0F, 0.0F, 0.0F, 1.0F}});
  const auto tile = map.snapshot()->tiles.at(0);
  EXPECT_NEAR(tile->points[0].x_m, 10.0, 1e-5);
  EXPECT_NEAR(tile->points[0].y_m, 2.0, 1e-5);
  EXPECT_NEAR(tile->points[0].z_m, 1.0, 1e-5);
}

TEST(VoxelMap, OnlyChangedTilesAreCopied) {
  VoxelMap map(0.1, 1000);
  map.insert({}, std::vector<MapPoint>{{1, 1, 1, 0}, {100, 1, 1, 0}});
  const auto before = map.snapshot();
  map.insert({}, std::vector<MapPoint>{{101, 1, 1, 0}});
  const auto after = map.snapshot();
  ASSERT_EQ(after->tiles.size(), 2U);
  EXPECT_EQ(before->tiles[0], after->tiles[0]);
  EXPECT_NE(before->tiles[1], after->tiles[1]);
  EXPECT_EQ(before->tiles[1]->points.size(), 1U);  // what was published stays as it was
  EXPECT_GT(after->tiles[1]->revision, before->tiles[1]->revision);
}

TEST(VoxelMap, PointsMoveWithTheViewThatBroughtThem) {
  VoxelMap map(0.1, 1000);
  map.insert({}, std::vector<MapPoint>{{1, 1, 1, 5}, {100, 1, 1, 6}});
  map.insert({}, std::vector<MapPoint>{{1, 2, 1, 7}});
  const auto before = map.snapshot();
  const Pose ahead{Eigen::Quaterniond::Identity(), {20.0, 0.0, 0.0}};
  map.move(std::vector<Pose>{{}, ahead});
  const auto after = map.snapshot();
  EXPECT_EQ(after->point_count, 3U);
  ASSERT_EQ(after->tiles.size(), 3U);
  EXPECT_FLOAT_EQ(after->tiles[0]->points[0].x_m, 1.0F);
  EXPECT_FLOAT_EQ(after->tiles[1]->points[0].x_m, 21.0F);
  EXPECT_FLOAT_EQ(after->tiles[1]->points[0].intensity, 7.0F);
  EXPECT_EQ(before->tiles[0]->points.size(), 2U);  // what was published stays as it was
  EXPECT_EQ(after->moved_revision, after->revision);
  // Where a point went, there is no room for another one.
  map.insert({}, std::vector<MapPoint>{{21.0F, 2, 1, 8}, {1, 2, 1, 9}});
  EXPECT_EQ(map.point_count(), 4U);
}

TEST(VoxelMap, PointsThatMeetInAVoxelBothStay) {
  VoxelMap map(0.1, 2);
  map.insert({}, std::vector<MapPoint>{{1.0F, 1, 1, 5}});
  map.insert({}, std::vector<MapPoint>{{1.3F, 1, 1, 6}});
  map.move(std::vector<Pose>{{}, {Eigen::Quaterniond::Identity(), {-0.3, 0.0, 0.0}}});
  EXPECT_EQ(map.point_count(), 2U);
  EXPECT_EQ(map.snapshot()->points_refused, 0U);
}

TEST(VoxelMap, TilesThatAreLeftEmptyAreToldUntilTheyFillAgain) {
  VoxelMap map(0.1, 1000);
  map.insert({}, std::vector<MapPoint>{{100, 1, 1, 0}});
  map.move(std::vector<Pose>{{Eigen::Quaterniond::Identity(), {-50.0, 0.0, 0.0}}});
  const auto moved = map.snapshot();
  ASSERT_EQ(moved->removed.size(), 1U);
  EXPECT_EQ(moved->removed[0].index, (TileIndex{6, 0, 0}));
  EXPECT_EQ(moved->removed[0].revision, moved->revision);
  map.insert({}, std::vector<MapPoint>{{100, 1, 1, 0}});
  EXPECT_TRUE(map.snapshot()->removed.empty());
}

TEST(VoxelMap, IsBoundedAndCountsWhatItRefuses) {
  VoxelMap map(0.1, 3);
  std::vector<MapPoint> points;
  points.reserve(5);
  for (int i = 0; i < 5; ++i) points.push_back({static_cast<float>(i), -20.0F, 0.0F, 0.0F});
  map.insert({}, points);
  EXPECT_EQ(map.point_count(), 3U);
  EXPECT_EQ(map.snapshot()->points_refused, 2U);
}

TEST(VoxelMap, ImpossibleCoordinatesAreLeftOut) {
  VoxelMap map(0.1, 10);
  map.insert({}, std::vector<MapPoint>{{NAN, 0, 0, 0}, {1e9F, 0, 0, 0}, {INFINITY, 0, 0, 0}});
  EXPECT_EQ(map.point_count(), 0U);
}

}  // namespace
}  // namespace glint::slam
