// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "slam/features.hpp"

namespace glint::slam {

/// How much a visual word weighs in an image.
struct WordWeight {
  std::uint32_t word = 0;
  float weight = 0.0F;
};

/// An image as a bag of visual words: by word, the weights sum to 1. Empty for an image without
/// descriptors, or with none but words that every image has.
using BagOfWords = std::vector<WordWeight>;

/// Similarity of two images, 0 to 1: 1 - |a - b| / 2 in the L1 norm
/// [Nister & Stewenius 2006, "Scalable Recognition with a Vocabulary Tree"].
double similarity(const BagOfWords& a, const BagOfWords& b);

/// A tree of binary descriptors; its leaves are the visual words. A descriptor goes down the tree
/// by the nearest child [Galvez-Lopez & Tardos 2012, "Bags of Binary Words"].
/// Immutable, so any thread.
class Vocabulary {
 public:
  struct Node {
    Descriptor centre{};
    std::uint32_t first_child = 0;  ///< Its children lie side by side.
    std::uint32_t children = 0;     ///< 0: a leaf.
    std::uint32_t word = 0;         ///< Of a leaf.
  };

  /// Most children of a node, and most levels below the root.
  static constexpr std::uint32_t kMaxBranching = 64;
  static constexpr std::uint32_t kMaxDepth = 16;

  /// A tree from its nodes in breadth-first order and how many of the `images` it was trained on
  /// have each word.
  Vocabulary(std::vector<Node> nodes, std::vector<std::uint32_t> images_with_word,
             std::uint32_t images);

  /// Reads what bytes() wrote. @throws InputError that begins with `name` if it is damaged, of
  /// another version or no vocabulary.
  static Vocabulary parse(std::span<const std::byte> bytes, std::string_view name);
  /// @throws InputError naming the file if it cannot be read or parse() refuses it.
  static Vocabulary load(const std::filesystem::path& file);
  /// The vocabulary as a file holds it, see vocabulary_file.cpp.
  [[nodiscard]] std::vector<std::byte> bytes() const;

  /// The word of a descriptor.
  [[nodiscard]] std::uint32_t word_of(const Descriptor& descriptor) const;
  /// Weighs words by how often the image has them and how few of the training images do (tf-idf).
  [[nodiscard]] BagOfWords bag_of(std::span<const Descriptor> descriptors) const;
  [[nodiscard]] std::size_t word_count() const { return images_with_word_.size(); }
  /// Tells one vocabulary from another: the checksum of its bytes.
  [[nodiscard]] std::uint64_t hash() const { return hash_; }

 private:
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> images_with_word_;
  std::uint32_t images_ = 0;
  std::vector<float> idf_;  ///< Of each word.
  std::uint64_t hash_ = 0;
};

/// The vocabulary that is part of this program.
std::shared_ptr<const Vocabulary> default_vocabulary();
/// The vocabulary of a file; of an empty path, the default one. @throws InputError as load().
std::shared_ptr<const Vocabulary> open_vocabulary(const std::filesystem::path& file);

}  // namespace glint::slam
