// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "pcap/recording/byte_reader.hpp"

namespace glint::recording {

/// A table inside a FlatBuffers buffer, of whose fields the numbers are known from its schema.
/// Every access is checked: what is absent or would lie outside the buffer comes back null or
/// empty. Non-owning. Thread-compatible.
class FlatTable {
 public:
  /// The root table of a buffer that has its size in front and carries a file identifier of four
  /// letters. Null if it does not.
  static std::optional<FlatTable> root(ByteSpan sized_buffer, std::string_view identifier);

  [[nodiscard]] std::optional<std::uint64_t> u64(int field) const;
  /// A string, or a vector of bytes.
  [[nodiscard]] ByteSpan bytes(int field) const;
  /// Entry `index` of a vector of tables; null past its end.
  [[nodiscard]] std::optional<FlatTable> table(int field, std::uint32_t index) const;

 private:
  FlatTable(ByteSpan buffer, std::uint64_t at) : buffer_(buffer), at_(at) {}
  [[nodiscard]] ByteReader reader_at(std::uint64_t position) const;
  [[nodiscard]] std::optional<std::uint64_t> position_of(int field) const;
  /// Where the vector that a field refers to begins, with its length.
  [[nodiscard]] std::optional<std::uint64_t> vector_of(int field) const;

  ByteSpan buffer_;
  std::uint64_t at_;
};

}  // namespace glint::recording
