// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "slam/loops/vocabulary.hpp"

namespace glint::slam {

/// The CRC-64 that ends the vocabulary's bytes().
std::uint64_t vocabulary_checksum(std::span<const Vocabulary::Node> nodes,
                                  std::span<const std::uint32_t> images_with_word,
                                  std::uint32_t images);

}  // namespace glint::slam
