// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace glint::recording {

using ByteSpan = std::span<const std::byte>;

/// The text that bytes spell.
inline std::string_view as_text(ByteSpan bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Reads integers and runs of bytes one after the other, and never outside its bytes: what would
/// reach past their end reads as zero or empty, and from then on ok() is false.
/// Non-owning. Thread-compatible.
class ByteReader {
 public:
  ByteReader() = default;
  explicit ByteReader(ByteSpan bytes, bool big_endian = false)
      : bytes_(bytes), big_endian_(big_endian) {}

  template <std::unsigned_integral T>
  T integer() {
    std::uint64_t value = 0;
    const ByteSpan from = bytes(sizeof(T));
    for (std::size_t i = 0; i < from.size(); ++i) {
      const std::size_t place = big_endian_ ? from.size() - 1 - i : i;
      value |= std::to_integer<std::uint64_t>(from[i]) << (8 * place);
    }
    return static_cast<T>(value);
  }

  ByteSpan bytes(std::uint64_t count) {
    if (count > bytes_.size()) {
      ok_ = false;
      bytes_ = {};
      return {};
    }
    const ByteSpan taken = bytes_.first(static_cast<std::size_t>(count));
    bytes_ = bytes_.subspan(taken.size());
    return taken;
  }

  std::string_view text(std::uint64_t count) { return as_text(bytes(count)); }

  /// False once something was asked for that is not there.
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  /// What is not yet read.
  [[nodiscard]] ByteSpan rest() const { return bytes_; }

 private:
  ByteSpan bytes_;
  bool big_endian_ = false;
  bool ok_ = true;
};

}  // namespace glint::recording
