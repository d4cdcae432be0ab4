// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/protocol_map.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>
#include <set>

#include "daemon/base64.hpp"

namespace glint::daemon {
namespace {

using slam::MapPoint;

class MapPageTest : public testing::Test {
 protected:
  /// Tiles in a row along x, with random points.
  void fill(int tiles, std::size_t points_per_tile) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> within(0.0F, 16.0F);
    for (int k = 0; k < tiles; ++k) {
      auto tile = std::make_shared<slam::MapTile>();
      tile->index = {k, 0, -1};
      tile->revision = static_cast<std::uint64_t>(k) + 1;
      std::vector<MapPoint> points;
      for (std::size_t i = 0; i < points_per_tile; ++i) {
        points.push_back({static_cast<float>(k) * 16.0F + within(random), within(random),
                          within(random) - 16.0F, static_cast<float>(i)});
      }
      tile->points = std::move(points);
      map_.point_count += tile->points.size();
      map_.tiles.push_back(std::move(tile));
    }
    map_.revision = static_cast<std::uint64_t>(tiles);
  }

  /// All pages put together as a client does.
  std::map<slam::TileIndex, std::vector<MapPoint>> fetch(Json params) {
    std::map<slam::TileIndex, std::vector<MapPoint>> tiles;
    pages_ = 0;
    while (true) {
      const Json page = map_page(parse_map_query(params), map_);
      EXPECT_LT(page.dump().size() + 1000, kMaxLineBytes);
      ++pages_;
      for (const Json& tile : page["tiles"]) {
        auto& points = tiles[tile["index"].get<slam::TileIndex>()];
        if (!tile["continued"].get<bool>()) points.clear();
        const auto bytes = base64_decode(tile["points"].get<std::string>()).value();
        const std::size_t known = points.size();
        points.resize(known + bytes.size() / sizeof(MapPoint));
        if (!bytes.empty()) std::memcpy(&points[known], bytes.data(), bytes.size());
      }
      if (!page.contains("next_cursor")) return tiles;
      params["cursor"] = page["next_cursor"];
    }
  }

  static std::size_t count(const std::map<slam::TileIndex, std::vector<MapPoint>>& tiles) {
    std::size_t n = 0;
    for (const auto& [index, points] : tiles) n += points.size();
    return n;
  }

  slam::MapSnapshot map_;
  int pages_ = 0;
};

TEST_F(MapPageTest, PagesAddUpToTheMapEvenWhenATileIsLargerThanAPage) {
  fill(3, 70'000);
  const auto tiles = fetch(Json::object());
  EXPECT_GT(pages_, 3);
  ASSERT_EQ(tiles.size(), 3U);
  for (const auto& tile : map_.tiles) {
    const auto& got = tiles.at(tile->index);
    ASSERT_EQ(got.size(), tile->points.size());
    EXPECT_EQ(std::memcmp(got.data(), tile->points.data(), got.size() * sizeof(MapPoint)), 0);
  }
}

TEST_F(MapPageTest, ThinningIsTheSameWhateverThePages) {
  fill(1, 120'000);
  const auto tiles = fetch({{"voxel_m", 0.25}});
  EXPECT_GT(pages_, 1);
  std::set<std::array<int, 3>> voxels;
  for (const MapPoint& p : map_.tiles[0]->points) {
    voxels.insert({static_cast<int>(std::floor(p.x_m / 0.25)),
                   static_cast<int>(std::floor(p.y_m / 0.25)),
                   static_cast<int>(std::floor(p.z_m / 0.25))});
  }
  EXPECT_EQ(count(tiles), voxels.size());
}

TEST_F(MapPageTest, OnlyTilesThatChangedAreSent) {
  fill(5, 10);
  const auto tiles = fetch({{"since_revision", 3}});
  EXPECT_EQ(tiles.size(), 2U);
  EXPECT_TRUE(tiles.contains({3, 0, -1}));
}

TEST_F(MapPageTest, ARegionCutsTilesAndPoints) {
  fill(5, 1000);
  const auto tiles =
      fetch({{"region", {{"min_m", {20.0, 0.0, -16.0}}, {"max_m", {30.0, 16.0, 0.0}}}}});
  ASSERT_EQ(tiles.size(), 1U);
  const auto& points = tiles.at({1, 0, -1});
  EXPECT_GT(points.size(), 300U);
  for (const MapPoint& p : points) EXPECT_TRUE(p.x_m >= 20.0F && p.x_m <= 30.0F);
}

TEST_F(MapPageTest, TheRevisionIsThatOfTheFirstPage) {
  fill(3, 70'000);
  const Json first = map_page(parse_map_query(Json::object()), map_);
  map_.revision = 99;
  const Json second = map_page(parse_map_query({{"cursor", first["next_cursor"]}}), map_);
  EXPECT_EQ(second["revision"], 3);
}

TEST_F(MapPageTest, ACursorFromBeforeACorrectionIsRefused) {
  fill(3, 70'000);
  const Json first = map_page(parse_map_query(Json::object()), map_);
  map_.moved_revision = ++map_.revision;
  try {
    map_page(parse_map_query({{"cursor", first["next_cursor"]}}), map_);
    FAIL() << "pages of two maps were mixed";
  } catch (const RpcError& error) {
    EXPECT_EQ(error.to_json()["data"]["code"], "OUT_OF_RANGE");
  }
}

TEST_F(MapPageTest, TilesThatAreNoMoreAreListedForWhoMayKnowThem) {
  fill(3, 10);
  map_.removed.push_back({{9, 0, 0}, 2});
  EXPECT_EQ(map_page(parse_map_query({{"since_revision", 1}}), map_)["removed"], Json({{9, 0, 0}}));
  EXPECT_TRUE(map_page(parse_map_query({{"since_revision", 2}}), map_)["removed"].empty());
  EXPECT_TRUE(map_page(parse_map_query(Json::object()), map_)["removed"].empty());
}

TEST_F(MapPageTest, JsonPointsAreNumbers) {
  fill(1, 3);
  const Json page = map_page(parse_map_query({{"encoding", "json"}}), map_);
  const Json& point = page["tiles"][0]["points"][2];
  ASSERT_EQ(point.size(), 4U);
  EXPECT_EQ(point[3].get<float>(), 2.0F);
}

TEST_F(MapPageTest, AFullPageOfJsonPointsFitsIntoALine) {
  fill(1, 70'000);
  EXPECT_LT(map_page(parse_map_query({{"encoding", "json"}}), map_).dump().size() + 1000,
            kMaxLineBytes);
}

TEST_F(MapPageTest, BadParametersNameTheirField) {
  for (const auto& [field, value] :
       std::initializer_list<std::pair<const char*, Json>>{{"voxel_m", -1},
                                                           {"voxel_m", "x"},
                                                           {"cursor", "1:2:3"},
                                                           {"cursor", "1:2:3:4:5x"},
                                                           {"region", {{"min_m", {0, 0}}}},
                                                           {"since_revision", -1},
                                                           {"encoding", "xml"}}) {
    try {
      parse_map_query(Json{{field, value}});
      ADD_FAILURE() << field << " " << value;
    } catch (const RpcError& error) {
      EXPECT_EQ(error.to_json()["data"]["field"], field);
    }
  }
}

TEST(Base64Test, IsTheInverseOfItselfAndOfTheStandard) {
  const auto bytes = [](std::string_view text) { return std::as_bytes(std::span(text)); };
  EXPECT_EQ(base64_encode(bytes("")), "");
  EXPECT_EQ(base64_encode(bytes("f")), "Zg==");
  EXPECT_EQ(base64_encode(bytes("fo")), "Zm8=");
  EXPECT_EQ(base64_encode(bytes("foobar")), "Zm9vYmFy");
  std::mt19937 random(1);
  for (std::size_t n = 0; n < 50; ++n) {
    std::vector<std::byte> data(n);
    for (std::byte& b : data) b = static_cast<std::byte>(random());
    EXPECT_EQ(base64_decode(base64_encode(data)), data);
  }
  EXPECT_FALSE(base64_decode("Zg=").has_value());
  EXPECT_FALSE(base64_decode("Z!==").has_value());
}

}  // namespace
}  // namespace glint::daemon
