// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>

namespace glint {

static_assert(std::endian::native == std::endian::little, "the wire is little-endian");

/// The little-endian value at an address of any alignment.
template <class T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// Writes a value little-endian to an address of any alignment.
template <class T>
void store(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof value);
}

}  // namespace glint
