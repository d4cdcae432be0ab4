// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/words_codec.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace glint::slam {
namespace {

static_assert(std::endian::native == std::endian::little, "words are kept as they lie in memory");
static_assert(sizeof(WordWeight) == sizeof(std::uint32_t) + sizeof(float));

// By word, each once, none without weight: as a bag is.
bool is_bag(const BagOfWords& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!std::isfinite(words[i].weight) || words[i].weight <= 0.0F) return false;
    if (i > 0 && words[i].word <= words[i - 1].word) return false;
  }
  return true;
}

}  // namespace

std::vector<std::byte> encode_words(const BagOfWords& words) {
  const auto bytes = std::as_bytes(std::span(words));
  return {bytes.begin(), bytes.end()};
}

std::optional<BagOfWords> decode_words(std::span<const std::byte> bytes) {
  if (bytes.size() % sizeof(WordWeight) != 0) return std::nullopt;
  BagOfWords words(bytes.size() / sizeof(WordWeight));
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
  if (!is_bag(words)) return std::nullopt;
  return words;
}

}  // namespace glint::slam
