// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/place_shelf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace glint::slam {
namespace {

Place shown(std::uint64_t keyframe) {
  Place place;
  place.id = keyframe;
  place.points_m = std::vector<Eigen::Vector3f>{{static_cast<float>(keyframe), 0.0F, 0.0F}};
  place.voxel_m = 0.5F;
  return place;
}

Pose at_x(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}; }

std::vector<std::uint64_t> ids(const std::vector<Place>& places) {
  std::vector<std::uint64_t> out;
  for (const Place& place : places) out.push_back(place.id);
  return out;
}

/// `count` places a metre apart, those from `second` on of another segment; tells what is read.
struct Shelf {
  explicit Shelf(std::size_t count, std::size_t second = SIZE_MAX) {
    shelf.read_with([this](std::uint64_t keyframe) -> std::optional<Place> {
      read.push_back(keyframe);
      if (keyframe == damaged) return std::nullopt;
      return shown(keyframe);
    });
    for (std::size_t i = 0; i < count; ++i) {
      shelf.add_unread(i, i < second ? 0 : 1, at_x(static_cast<double>(i)));
    }
  }
  PlaceShelf shelf;
  std::vector<std::uint64_t> read;
  std::uint64_t damaged = UINT64_MAX;
};

TEST(PlaceShelf, APlaceIsReadWhenItIsLookedAtAndStays) {
  Shelf map(20);
  EXPECT_THAT(map.read, testing::IsEmpty());
  EXPECT_EQ(map.shelf.pose(7).translation_m.x(), 7.0);
  for (int i = 0; i < 2; ++i) {
    const Place place = map.shelf.at(7);
    ASSERT_EQ(place.points_m.size(), 1U);
    EXPECT_EQ(place.points_m[0].x(), 7.0F);
    EXPECT_EQ(place.voxel_m, 0.5F);
    EXPECT_EQ(place.T_odom_sensor.translation_m.x(), 7.0) << "where the map has it";
  }
  EXPECT_THAT(map.read, testing::ElementsAre(7U));
}

TEST(PlaceShelf, OnlyTheLatestStayAndWhoHoldsOneKeepsIt) {
  Shelf map(PlaceShelf::kMostRead + 1);
  const Place first = map.shelf.at(0);
  for (std::size_t i = 1; i <= PlaceShelf::kMostRead; ++i) map.shelf.at(i);
  EXPECT_EQ(first.points_m[0].x(), 0.0F);
  map.read.clear();
  EXPECT_EQ(map.shelf.at(2).points_m.size(), 1U);
  EXPECT_THAT(map.read, testing::IsEmpty());
  EXPECT_EQ(map.shelf.at(0).points_m.size(), 1U);
  EXPECT_THAT(map.read, testing::ElementsAre(0U));
}

TEST(PlaceShelf, WhatCannotBeReadShowsNothing) {
  Shelf map(5);
  map.damaged = 3;
  const Place place = map.shelf.at(3);
  EXPECT_TRUE(place.points_m.empty());
  EXPECT_GT(place.voxel_m, 0.0F);
  EXPECT_EQ(map.shelf.at(2).points_m.size(), 1U);
}

TEST(PlaceShelf, AroundAPlaceAreThoseOfItsSegmentInOrder) {
  Shelf map(10, 6);
  EXPECT_THAT(ids(map.shelf.around(4, 3)), testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(ids(map.shelf.around(6, 2)), testing::ElementsAre(6, 7, 8));
  EXPECT_THAT(ids(map.shelf.around(9, 1)), testing::ElementsAre(8, 9));
}

TEST(PlaceShelf, TheNearestComeFirstAndOnlyTheyAreRead) {
  Shelf map(10);
  EXPECT_THAT(ids(map.shelf.nearest({4.2, 0.0, 0.0}, 3, 15.0)), testing::ElementsAre(4, 5, 3));
  EXPECT_THAT(map.read, testing::UnorderedElementsAre(3, 4, 5));
  EXPECT_THAT(ids(map.shelf.nearest({-1.5, 0.0, 0.0}, 9, 3.0)), testing::ElementsAre(0, 1));
}

TEST(PlaceShelf, PlacesThatWereAddedWholeAreNeverReadOrPutAway) {
  Shelf map(PlaceShelf::kMostRead + 5);
  const std::size_t whole = map.shelf.size();
  map.shelf.add(shown(1234));
  for (std::size_t i = 0; i < whole; ++i) map.shelf.at(i);
  map.read.clear();
  EXPECT_EQ(map.shelf.at(whole).points_m.size(), 1U);
  EXPECT_THAT(map.read, testing::IsEmpty());
}

}  // namespace
}  // namespace glint::slam
