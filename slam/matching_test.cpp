// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/matching.hpp"

#include <gtest/gtest.h>

#include <random>

namespace glint::slam {
namespace {

std::vector<Descriptor> random_descriptors(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Descriptor> result(count);
  for (Descriptor& d : result) {
    for (auto& word : d) word = random();
  }
  return result;
}

Descriptor with_bits_flipped(Descriptor d, int count) {
  for (int bit = 0; bit < count; ++bit) d[static_cast<std::size_t>(bit % 4)] ^= 1ULL << (bit / 4);
  return d;
}

TEST(HammingDistance, CountsDifferingBits) {
  const Descriptor zero{};
  EXPECT_EQ(hamming_distance(zero, zero), 0);
  EXPECT_EQ(hamming_distance(zero, with_bits_flipped(zero, 37)), 37);
  EXPECT_EQ(hamming_distance(zero, {~0ULL, ~0ULL, ~0ULL, ~0ULL}), 256);
}

TEST(MatchScore, FallsWithDistanceAndStaysPositive) {
  EXPECT_DOUBLE_EQ(match_score(0), 1.0);
  EXPECT_DOUBLE_EQ(match_score(40), 0.5);
  EXPECT_DOUBLE_EQ(match_score(80), 0.05);
  EXPECT_DOUBLE_EQ(match_score(256), 0.05);
}

TEST(Matcher, FindsShuffledDescriptorsAgain) {
  const auto reference = random_descriptors(100, 1);
  std::vector<Descriptor> current;
  for (std::size_t i = 0; i < 100; ++i) {
    current.push_back(with_bits_flipped(reference[(i * 37) % 100], static_cast<int>(i % 30)));
  }
  Matcher matcher({.max_distance = 64, .keep_share = 1.0, .max_matches = 1000});
  const auto& matches = matcher.match(reference, current);
  ASSERT_EQ(matches.size(), 100U);
  for (const Match& m : matches) {
    EXPECT_EQ(m.reference, (m.current * 37) % 100);
    EXPECT_EQ(m.distance, m.current % 30);
  }
}

TEST(Matcher, KeepsOnlyPairsThatAreEachOthersNearest) {
  const Descriptor a{};
  // Both current ones are nearest to `a`, which likes the second better.
  const std::vector<Descriptor> reference = {a};
  const std::vector<Descriptor> current = {with_bits_flipped(a, 9), with_bits_flipped(a, 4)};
  Matcher matcher({.max_distance = 64, .keep_share = 1.0, .max_matches = 10});
  const auto& matches = matcher.match(reference, current);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].current, 1);
}

TEST(Matcher, KeepsTheBestShareAndNoneTooFar) {
  const auto reference = random_descriptors(100, 2);
  std::vector<Descriptor> current;
  for (std::size_t i = 0; i < 100; ++i) {
    current.push_back(with_bits_flipped(reference[i], static_cast<int>(i)));
  }
  Matcher thirty({.max_distance = 64, .keep_share = 0.3, .max_matches = 200});
  const auto best = thirty.match(reference, current);
  ASSERT_EQ(best.size(), 30U);
  EXPECT_EQ(best.back().distance, 29);
  Matcher near({.max_distance = 10, .keep_share = 1.0, .max_matches = 200});
  EXPECT_EQ(near.match(reference, current).size(), 11U);
}

TEST(Matcher, EmptySetsGiveNoMatches) {
  Matcher matcher({});
  EXPECT_TRUE(matcher.match({}, random_descriptors(3, 3)).empty());
  EXPECT_TRUE(matcher.match(random_descriptors(3, 3), {}).empty());
}

}  // namespace
}  // namespace glint::slam
