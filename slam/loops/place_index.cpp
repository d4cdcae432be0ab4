// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/place_index.hpp"

#include <algorithm>

namespace glint::slam {

void PlaceIndex::add(const BagOfWords& bag) {
  for (const WordWeight& word : bag) {
    entries_of_word_[word.word].push_back({static_cast<std::uint32_t>(size_), word.weight});
  }
  ++size_;
}

void PlaceIndex::renumber(std::span<const std::size_t> number_now, std::size_t size) {
  for (std::vector<Posting>& postings : entries_of_word_) {
    for (Posting& posting : postings) {
      posting.entry = static_cast<std::uint32_t>(number_now[posting.entry]);
    }
  }
  size_ = size;
}

const std::vector<ScoredPlace>& PlaceIndex::query(const BagOfWords& bag, std::size_t end,
                                                  double least) {
  sums_.assign(std::min(end, size_), 0.0);
  for (const WordWeight& word : bag) {
    for (const Posting& posting : entries_of_word_[word.word]) {
      if (posting.entry >= sums_.size()) break;  // They are in order.
      sums_[posting.entry] += static_cast<double>(std::min(posting.weight, word.weight));
    }
  }
  found_.clear();
  for (std::size_t entry = 0; entry < sums_.size(); ++entry) {
    if (sums_[entry] >= least) found_.push_back({entry, sums_[entry]});
  }
  return found_;
}

}  // namespace glint::slam
