// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/place_index.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace glint::slam {
namespace {

constexpr std::uint32_t kWords = 200;

BagOfWords random_bag(std::mt19937& random) {
  std::map<std::uint32_t, float> weights;
  for (int i = 0; i < 30; ++i)
    weights[static_cast<std::uint32_t>(random()) % kWords] += 1.0F / 30.0F;
  BagOfWords bag;
  for (const auto& [word, weight] : weights) bag.push_back({word, weight});
  return bag;
}

TEST(PlaceIndex, FindsWhatComparingWithAllFinds) {
  std::mt19937 random(5);
  std::vector<BagOfWords> bags;
  PlaceIndex index(kWords);
  for (int i = 0; i < 100; ++i) {
    bags.push_back(random_bag(random));
    index.add(bags.back());
  }
  ASSERT_EQ(index.size(), bags.size());
  for (const std::size_t end :
       {std::size_t{0}, std::size_t{60}, std::size_t{100}, std::size_t{999}}) {
    const BagOfWords asked = random_bag(random);
    std::size_t next = 0;
    const auto& found = index.query(asked, end, 0.15);
    for (std::size_t entry = 0; entry < std::min(end, bags.size()); ++entry) {
      const double expected = similarity(bags[entry], asked);
      if (expected < 0.15) continue;
      ASSERT_LT(next, found.size());
      EXPECT_EQ(found[next].entry, entry);
      EXPECT_NEAR(found[next].similarity, expected, 1e-9);
      ++next;
    }
    EXPECT_EQ(next, found.size());
    EXPECT_EQ(end == 0, found.empty());
  }
}

TEST(PlaceIndex, NothingIsLikeAnEmptyImage) {
  PlaceIndex index(kWords);
  index.add({});
  index.add({{3, 1.0F}});
  EXPECT_TRUE(index.query({}, 2, 0.01).empty());
  ASSERT_EQ(index.query({{3, 1.0F}}, 2, 0.01).size(), 1U);
}

}  // namespace
}  // namespace glint::slam
