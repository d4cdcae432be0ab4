// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "slam/loops/vocabulary.hpp"

namespace glint::slam {

/// Entry of a PlaceIndex and how alike it is to the image asked for.
struct ScoredPlace {
  std::size_t entry = 0;
  double similarity = 0.0;
};

/// Which images hold a visual word: finds those that are like a given one without looking at all of
/// them. Entries are numbered as they are added. Thread-compatible.
class PlaceIndex {
 public:
  explicit PlaceIndex(std::size_t word_count) : entries_of_word_(word_count) {}

  void add(const BagOfWords& bag);
  /// Entries without a word are taken out: `number_now` of each entry left, in the same order, of
  /// `size` that are.
  void renumber(std::span<const std::size_t> number_now, std::size_t size);
  /// The entries before `end` whose similarity() to `bag` is at least `least`, in order.
  /// Valid until the next call.
  const std::vector<ScoredPlace>& query(const BagOfWords& bag, std::size_t end, double least);
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Posting {
    std::uint32_t entry = 0;
    float weight = 0.0F;
  };

  std::vector<std::vector<Posting>> entries_of_word_;
  std::size_t size_ = 0;
  std::vector<double> sums_;  ///< Of each entry; reused.
  std::vector<ScoredPlace> found_;
};

}  // namespace glint::slam
