// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/nearest_descriptors.hpp"

#include <gtest/gtest.h>

#include <random>

namespace glint::slam {
namespace {

// Of few bits, so that there are ties.
std::vector<Descriptor> random_descriptors(std::size_t count, std::mt19937_64& random,
                                           std::uint64_t bits) {
  std::vector<Descriptor> result(count);
  for (Descriptor& d : result) {
    for (auto& word : d) word = random() & bits;
  }
  return result;
}

class NearestPaths : public testing::TestWithParam<NearestPath> {};

TEST_P(NearestPaths, AllFindTheSame) {
  std::mt19937_64 random(5);
  NearestDescriptors portable(NearestPath::kPortable);
  NearestDescriptors other(GetParam());
  for (const std::size_t references : {1U, 31U, 32U, 33U, 63U, 64U, 65U, 200U, 997U}) {
    for (const std::uint64_t bits : {~0ULL, 0x8421ULL, 0x1ULL}) {
      const auto reference = random_descriptors(references, random, bits);
      const auto current = random_descriptors(1 + random() % 300, random, bits);
      portable.find(reference, current);
      other.find(reference, current);
      EXPECT_EQ(other.of_reference().partner, portable.of_reference().partner);
      EXPECT_EQ(other.of_reference().distance, portable.of_reference().distance);
      EXPECT_EQ(other.of_current().partner, portable.of_current().partner);
      EXPECT_EQ(other.of_current().distance, portable.of_current().distance);
    }
  }
}

TEST_P(NearestPaths, OppositesAndNothingHaveNoNearest) {
  NearestDescriptors nearest(GetParam());
  const Descriptor zeros{};
  const Descriptor ones{~0ULL, ~0ULL, ~0ULL, ~0ULL};
  const Descriptor nearly{~0ULL, ~0ULL, ~0ULL, ~3ULL};
  const auto find = [&](const std::vector<Descriptor>& reference,
                        const std::vector<Descriptor>& current) {
    nearest.find(reference, current);
  };
  find({zeros}, {ones});
  EXPECT_EQ(nearest.of_current().partner, (std::vector<std::int32_t>{-1}));
  EXPECT_EQ(nearest.of_reference().partner, (std::vector<std::int32_t>{-1}));
  find({zeros}, {ones, nearly});
  EXPECT_EQ(nearest.of_current().partner, (std::vector<std::int32_t>{-1, 0}));
  EXPECT_EQ(nearest.of_reference().partner, (std::vector<std::int32_t>{1}));
  EXPECT_EQ(nearest.of_reference().distance, (std::vector<std::uint8_t>{254}));
  find({}, {ones});
  EXPECT_EQ(nearest.of_current().partner, (std::vector<std::int32_t>{-1}));
  find({ones}, {});
  EXPECT_EQ(nearest.of_reference().partner, (std::vector<std::int32_t>{-1}));
}

INSTANTIATE_TEST_SUITE_P(Paths, NearestPaths, testing::ValuesIn(nearest_paths()));

}  // namespace
}  // namespace glint::slam
