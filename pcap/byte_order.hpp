// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace glint {

using Bytes = std::span<const std::uint8_t>;

/// Big-endian integer at `at`; the caller has checked that the bytes are there.
inline std::uint16_t load_be16(Bytes bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8) | bytes[at + 1]);
}
inline std::uint32_t load_be32(Bytes bytes, std::size_t at) {
  return (std::uint32_t{load_be16(bytes, at)} << 16) | load_be16(bytes, at + 2);
}

}  // namespace glint
