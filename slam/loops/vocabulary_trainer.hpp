// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/loops/vocabulary.hpp"

namespace glint::slam {

struct VocabularyOptions {
  std::uint32_t branching = 10;  ///< Children of a node, 2 to Vocabulary::kMaxBranching.
  std::uint32_t depth = 4;       ///< Levels below the root, 1 to Vocabulary::kMaxDepth.
  int rounds = 12;               ///< Most times that a node's descriptors are shared out anew.
};

/// Grows a vocabulary tree: each node's descriptors are parted by k-majority (Lloyd's rounds in the
/// Hamming distance, centres by majority of each bit), starting from descriptors that lie far apart
/// as in k-means++. `images` are the descriptors of one training image each. The same images give
/// the same tree. @throws InputError if they hold no descriptors, or are more than 65535.
Vocabulary train_vocabulary(std::span<const std::vector<Descriptor>> images,
                            const VocabularyOptions& options = {});

}  // namespace glint::slam
