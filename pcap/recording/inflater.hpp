// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "pcap/recording/byte_reader.hpp"

namespace glint::recording {

enum class Compression { kNone, kBzip2, kLz4, kZstd };

/// By the name that bags and MCAP files use, "" and "none" for none; null for any other.
std::optional<Compression> compression_named(std::string_view name);

/// Whether bytes begin as a zstd frame does.
bool is_zstd(ByteSpan bytes);

/// Largest chunk or message, unpacked; some hundred times what recorders make.
constexpr std::uint64_t kMaxChunkBytes = std::uint64_t{256} << 20U;

/// What unpacking gave.
struct Inflated {
  ByteSpan bytes;      ///< All, or what there is of a stream cut short. Valid until the next call.
  bool whole = false;  ///< The stream was sound and not larger than allowed.
};

/// Unpacks chunks. What one may unpack to is limited, and so is what all together may: that keeps
/// files of any size from costing more than about a thousand times the time to read them.
/// Thread-compatible.
class Inflater {
 public:
  /// Unpacks `packed`, at most kMaxChunkBytes. Of a stream that breaks off or is too large, what
  /// could be unpacked is returned; of a damaged one, nothing. Without compression, `packed`
  /// itself.
  Inflated inflate(Compression compression, ByteSpan packed);

 private:
  std::vector<std::byte> buffer_;
  std::uint64_t allowance_ = std::uint64_t{1} << 30U;
};

}  // namespace glint::recording
