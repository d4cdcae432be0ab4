// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/crc64.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string_view>
#include <vector>

namespace glint {
namespace {

std::uint64_t crc_of(std::string_view text) { return crc64(std::as_bytes(std::span(text))); }

TEST(Crc64, GivesTheCheckValueOfItsCatalogueEntry) {
  EXPECT_EQ(crc_of("123456789"), 0x995D'C9BB'DF19'39FAU);
  EXPECT_EQ(crc_of(""), 0U);
}

TEST(Crc64, TellsASingleBitApart) { EXPECT_NE(crc_of("123456789"), crc_of("123456788")); }

TEST(Crc64, IsTheSameByTablesAtEverySizeAndPlace) {
  std::mt19937 random(1);
  std::vector<std::byte> bytes(700);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  for (std::size_t size = 0; size < 600; ++size) {
    const auto part = std::span(bytes).subspan(size % 17, size);
    ASSERT_EQ(crc64(part), crc64_portable(part)) << size;
  }
}

}  // namespace
}  // namespace glint
