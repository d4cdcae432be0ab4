// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/vocabulary_trainer.hpp"

#include <algorithm>
#include <limits>
#include <random>
#include <utility>

#include "driver/core/error.hpp"
#include "slam/matching.hpp"

namespace glint::slam {
namespace {

constexpr std::size_t kBits = 256;

// The descriptors of a node, as a range of all of them.
struct Part {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::uint32_t level = 0;
};

Descriptor majority(std::span<const Descriptor> of) {
  std::array<std::uint32_t, kBits> ones{};
  for (const Descriptor& descriptor : of) {
    for (std::size_t bit = 0; bit < kBits; ++bit) {
      ones[bit] += static_cast<std::uint32_t>(descriptor[bit / 64] >> (bit % 64) & 1U);
    }
  }
  Descriptor centre{};
  for (std::size_t bit = 0; bit < kBits; ++bit) {
    if (2 * std::size_t{ones[bit]} > of.size()) centre[bit / 64] |= std::uint64_t{1} << (bit % 64);
  }
  return centre;
}

class Grower {
 public:
  Grower(std::vector<Descriptor> descriptors, const VocabularyOptions& options)
      : options_(options), all_(std::move(descriptors)), owner_(all_.size()), spare_(all_.size()) {}

  std::vector<Vocabulary::Node> grow() {
    nodes_.emplace_back();
    parts_.push_back({0, all_.size(), 0});
    // Breadth first: what is added is looked at later.
    for (std::size_t i = 0; i < nodes_.size(); ++i) part(i);
    return std::move(nodes_);
  }

 private:
  void part(std::size_t index) {
    const Part part = parts_[index];
    if (part.level >= options_.depth) return;
    choose_centres(part);
    if (centres_.size() < 2) return;  // All are the same descriptor.
    for (int round = 0; round < options_.rounds && share_out(part); ++round) move_centres(part);
    sort_by_owner(part);
    nodes_[index].first_child = static_cast<std::uint32_t>(nodes_.size());
    std::size_t begin = part.begin;
    for (std::uint32_t c = 0; c < centres_.size(); ++c) {
      std::size_t end = begin;
      while (end < part.end && owner_[end] == c) ++end;
      if (end == begin) continue;
      nodes_.push_back({centres_[c], 0, 0, 0});
      parts_.push_back({begin, end, part.level + 1});
      ++nodes_[index].children;
      begin = end;
    }
  }

  // The first at random, each further one more likely the farther it is from those chosen.
  void choose_centres(const Part& part) {
    centres_.assign(1, all_[part.begin + random_() % (part.end - part.begin)]);
    nearest_.assign(part.end - part.begin, std::numeric_limits<std::uint64_t>::max());
    while (centres_.size() < options_.branching) {
      std::uint64_t total = 0;
      for (std::size_t i = 0; i < nearest_.size(); ++i) {
        const auto bits =
            static_cast<std::uint64_t>(hamming_distance(all_[part.begin + i], centres_.back()));
        nearest_[i] = std::min(nearest_[i], bits * bits);
        total += nearest_[i];
      }
      if (total == 0) return;
      std::uint64_t left = (std::uint64_t{random_()} << 32U | random_()) % total;
      std::size_t chosen = 0;
      while (left >= nearest_[chosen]) left -= nearest_[chosen++];
      centres_.push_back(all_[part.begin + chosen]);
    }
  }

  // False when nothing changed hands.
  bool share_out(const Part& part) {
    bool changed = false;
    for (std::size_t i = part.begin; i < part.end; ++i) {
      std::uint32_t best = 0;
      int least = std::numeric_limits<int>::max();
      for (std::uint32_t c = 0; c < centres_.size(); ++c) {
        const int bits = hamming_distance(all_[i], centres_[c]);
        if (bits < least) {
          least = bits;
          best = c;
        }
      }
      changed = changed || owner_[i] != best;
      owner_[i] = best;
    }
    return changed;
  }

  void move_centres(const Part& part) {
    for (std::uint32_t c = 0; c < centres_.size(); ++c) {
      mine_.clear();
      for (std::size_t i = part.begin; i < part.end; ++i) {
        if (owner_[i] == c) mine_.push_back(all_[i]);
      }
      if (!mine_.empty()) centres_[c] = majority(mine_);
    }
  }

  void sort_by_owner(const Part& part) {
    share_out(part);
    std::size_t at = part.begin;
    for (std::uint32_t c = 0; c < centres_.size(); ++c) {
      for (std::size_t i = part.begin; i < part.end; ++i) {
        if (owner_[i] == c) spare_[at++] = all_[i];
      }
    }
    const auto range = [&](auto& of) {
      return std::span(of).subspan(part.begin, part.end - part.begin);
    };
    std::ranges::copy(range(spare_), range(all_).begin());
    std::ranges::sort(range(owner_));
  }

  const VocabularyOptions options_;
  std::vector<Descriptor> all_;
  std::vector<std::uint32_t> owner_;  ///< Which of the centres a descriptor is nearest to.
  std::vector<Descriptor> spare_;
  std::vector<Descriptor> centres_;
  std::vector<Descriptor> mine_;
  std::vector<std::uint64_t> nearest_;
  std::vector<Vocabulary::Node> nodes_;
  std::vector<Part> parts_;      ///< Of each node.
  std::mt19937 random_{271828};  // The same tree each time.
};

}  // namespace

Vocabulary train_vocabulary(std::span<const std::vector<Descriptor>> images,
                            const VocabularyOptions& options) {
  std::vector<Descriptor> all;
  for (const auto& image : images) all.insert(all.end(), image.begin(), image.end());
  if (all.empty()) {
    throw InputError("the captures hold no keypoints to train a vocabulary on; add others");
  }
  if (images.size() > std::numeric_limits<std::uint16_t>::max()) {
    throw InputError("a vocabulary is trained on 65535 images at most; take fewer of the scans");
  }
  std::vector<Vocabulary::Node> nodes = Grower(std::move(all), options).grow();
  std::uint32_t words = 0;
  for (Vocabulary::Node& node : nodes) {
    if (node.children == 0) node.word = words++;
  }
  const auto count = static_cast<std::uint32_t>(images.size());
  const Vocabulary tree(nodes, std::vector<std::uint32_t>(words), count);
  std::vector<std::uint32_t> images_with_word(words);
  for (const auto& image : images) {
    std::vector<std::uint32_t> seen;
    seen.reserve(image.size());
    for (const Descriptor& descriptor : image) seen.push_back(tree.word_of(descriptor));
    std::ranges::sort(seen);
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    for (const std::uint32_t word : seen) ++images_with_word[word];
  }
  return {std::move(nodes), std::move(images_with_word), count};
}

}  // namespace glint::slam
