// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/vocabulary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/loops/vocabulary_file.hpp"
#include "slam/matching.hpp"

namespace glint::slam {

double similarity(const BagOfWords& a, const BagOfWords& b) {
  // For weights that are positive and sum to 1 the norm comes to the sum of the lesser ones.
  double sum = 0.0;
  auto at = b.begin();
  for (const WordWeight& mine : a) {
    while (at != b.end() && at->word < mine.word) ++at;
    if (at == b.end()) break;
    if (at->word == mine.word) sum += static_cast<double>(std::min(mine.weight, at->weight));
  }
  return sum;
}

Vocabulary::Vocabulary(std::vector<Node> nodes, std::vector<std::uint32_t> images_with_word,
                       std::uint32_t images)
    : nodes_(std::move(nodes)), images_with_word_(std::move(images_with_word)), images_(images) {
  idf_.reserve(images_with_word_.size());
  for (const std::uint32_t having : images_with_word_) {
    // A word of no training image is as rare as one of a single image.
    idf_.push_back(static_cast<float>(
        std::log(static_cast<double>(images_) / std::max<std::uint32_t>(1U, having))));
  }
  hash_ = vocabulary_checksum(nodes_, images_with_word_, images_);
}

std::uint32_t Vocabulary::word_of(const Descriptor& descriptor) const {
  const Node* node = nodes_.data();
  while (node->children > 0) {
    const Node* const first = &nodes_[node->first_child];
    const Node* best = first;
    int least = hamming_distance(descriptor, first->centre);
    for (const Node* child = first + 1; child < first + node->children; ++child) {
      const int bits = hamming_distance(descriptor, child->centre);
      if (bits < least) {
        least = bits;
        best = child;
      }
    }
    node = best;
  }
  return node->word;
}

BagOfWords Vocabulary::bag_of(std::span<const Descriptor> descriptors) const {
  std::vector<std::uint32_t> words;
  words.reserve(descriptors.size());
  for (const Descriptor& descriptor : descriptors) words.push_back(word_of(descriptor));
  std::ranges::sort(words);
  BagOfWords bag;
  double total = 0.0;
  for (std::size_t i = 0; i < words.size();) {
    std::size_t end = i;
    while (end < words.size() && words[end] == words[i]) ++end;
    const float weight = static_cast<float>(end - i) * idf_[words[i]];
    if (weight > 0.0F) bag.push_back({words[i], weight});
    total += static_cast<double>(weight);
    i = end;
  }
  for (WordWeight& entry : bag) {
    entry.weight = static_cast<float>(static_cast<double>(entry.weight) / total);
  }
  return bag;
}

}  // namespace glint::slam
