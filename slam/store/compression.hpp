// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glint::slam {

/// Zstandard frame of the bytes, with their checksum. Any thread.
std::vector<std::byte> compress(std::span<const std::byte> bytes);

/// What compress() was given. Null when the frame is damaged, or would grow beyond `most_bytes`.
std::optional<std::vector<std::byte>> decompress(std::span<const std::byte> frame,
                                                 std::size_t most_bytes);

}  // namespace glint::slam
