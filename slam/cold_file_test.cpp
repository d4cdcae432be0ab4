// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/cold_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "slam/cold_array.hpp"

namespace glint::slam {
namespace {

std::shared_ptr<ColdFile> make_file() {
  return ColdFile::create(std::filesystem::temp_directory_path());
}

std::vector<int> numbers(int from, std::size_t count) {
  std::vector<int> all(count);
  for (int& number : all) number = from++;
  return all;
}

ColdArray<int> put(ColdFile& file, const std::vector<int>& values) {
  return {file.put(std::as_bytes(std::span(values))), values.size()};
}

TEST(ColdFile, WhatIsPutThereIsReadBackAlsoAfterARest) {
  const auto file = make_file();
  ASSERT_TRUE(file);
  const auto few = numbers(7, 3);
  const auto many = numbers(100, 50'000);
  const ColdArray<int> a = put(*file, few);
  const ColdArray<int> b = put(*file, many);
  file->rest();
  EXPECT_TRUE(std::ranges::equal(a, few));
  EXPECT_TRUE(std::ranges::equal(b, many));
  EXPECT_TRUE(b.is_cold());
  EXPECT_FALSE(ColdArray<int>(few).is_cold());
}

TEST(ColdFile, RoomIsUsedAnew) {
  const auto file = make_file();
  ASSERT_TRUE(file);
  const ColdArray<int> stays = put(*file, numbers(1, 1000));
  std::uint64_t most_bytes = 0;
  const int* lowest = nullptr;
  const int* highest = nullptr;
  for (int i = 0; i < 100; ++i) {
    const ColdArray<int> a = put(*file, numbers(i, 3000));
    const ColdArray<int> b = put(*file, numbers(i, static_cast<std::size_t>(100 * i)));
    most_bytes = std::max(most_bytes, file->bytes());
    if (lowest == nullptr) lowest = a.data();
    highest = std::max(highest, b.data());
  }
  EXPECT_LE(most_bytes, 64U << 10U);
  EXPECT_LT(highest - lowest, 64 << 10);
  EXPECT_EQ(file->bytes(), 4096U);
  EXPECT_TRUE(std::ranges::equal(stays, numbers(1, 1000)));
}

TEST(ColdFile, ItsLastValuesOutliveIt) {
  auto file = make_file();
  ASSERT_TRUE(file);
  const ColdArray<int> values = put(*file, numbers(5, 2000));
  file.reset();
  EXPECT_TRUE(std::ranges::equal(values, numbers(5, 2000)));
}

TEST(ColdFile, WithoutADirectoryThereIsNone) {
  EXPECT_EQ(ColdFile::create("/nowhere/at/all"), nullptr);
}

}  // namespace
}  // namespace glint::slam
