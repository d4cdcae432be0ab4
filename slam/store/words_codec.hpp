// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "slam/loops/vocabulary.hpp"

namespace glint::slam {

/// What a keyframe's image looks like, as the session keeps it: each word (little-endian uint32)
/// with its weight (float32). Not packed, since all of a map's are read when it is loaded.
std::vector<std::byte> encode_words(const BagOfWords& words);

/// Null where the bytes are no such list.
std::optional<BagOfWords> decode_words(std::span<const std::byte> bytes);

}  // namespace glint::slam
