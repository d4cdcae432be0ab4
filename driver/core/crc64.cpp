// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/crc64.hpp"

#include <array>

namespace glint {
namespace {

constexpr std::uint64_t kReversedPolynomial = 0xC96C'5795'D787'0F42;

// The remainder of each single byte.
constexpr auto kTable = [] {
  std::array<std::uint64_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::uint64_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ ((crc & 1U) != 0 ? kReversedPolynomial : 0);
    table[i] = crc;
  }
  return table;
}();

}  // namespace

std::uint64_t crc64(std::span<const std::byte> bytes) {
  std::uint64_t crc = ~std::uint64_t{0};
  for (const std::byte byte : bytes) {
    crc = crc >> 8U ^ kTable[(crc ^ static_cast<std::uint64_t>(byte)) & 0xFFU];
  }
  return ~crc;
}

}  // namespace glint
