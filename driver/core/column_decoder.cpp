// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/column_decoder.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>
#include <utility>

#include "driver/core/bytes.hpp"
#include "driver/core/column_kernel.hpp"
#include "driver/core/profile_table.hpp"

namespace glint {
namespace {

using kernel::ColumnBlock;
using kernel::kBlockColumns;

// Vectors of 128 bits in the compiler's own notation: SSE2 or NEON where there is one, else words.
struct PortableVector {
  static constexpr std::size_t kLanes = 4;
  typedef std::uint32_t Words __attribute__((vector_size(16)));
  typedef std::uint16_t Halves __attribute__((vector_size(16)));
  using Row = kernel::WordRow<PortableVector>;

  static Words load(const std::byte* at, std::size_t /*stride*/) { return glint::load<Words>(at); }
  static Words interleave_low(Words a, Words b) {
    return __builtin_shufflevector(a, b, 0, 4, 1, 5);
  }
  static Words interleave_high(Words a, Words b) {
    return __builtin_shufflevector(a, b, 2, 6, 3, 7);
  }
  static Words join_low(Words a, Words b) { return __builtin_shufflevector(a, b, 0, 1, 4, 5); }
  static Words join_high(Words a, Words b) { return __builtin_shufflevector(a, b, 2, 3, 6, 7); }

  static void store(const Row& row, std::uint32_t* out) {
    std::memcpy(out, row.part, sizeof row.part);
  }
  static void store(const Row& row, std::uint16_t* out) {
    for (std::size_t v = 0; v < Row::kVectors; v += 2, out += 8) {
      const auto a = reinterpret_cast<Halves>(row.part[v]);
      const auto b = reinterpret_cast<Halves>(row.part[v + 1]);
      const Halves packed = __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
      std::memcpy(out, &packed, sizeof packed);
    }
  }
};

template <std::size_t kProfile, Channel kChannel>
void decode_pixel(const ColumnBlock& block, const std::byte* pixel, std::size_t at) {
  constexpr PixelField kField = kProfileTable[kProfile].field(kChannel);
  if constexpr (kField.present()) {
    constexpr std::uint32_t kMask = (1U << kField.width_bits) - 1U;
    constexpr int kWordOffset = kField.offset_bits / 32 * 4;
    const auto word = load<std::uint32_t>(pixel + kWordOffset);
    auto* const out = block.out<kChannel>() + at;
    *out = static_cast<std::remove_pointer_t<decltype(out)>>(
        (word >> kField.offset_bits % 32 & kMask) * std::uint32_t{kField.scale});
  }
}

// The pixels that make no whole tiles: the last rows of a block, and columns fewer than a block.
template <std::size_t kProfile>
void decode_pixels(const ColumnBlock& block, int columns, int first_row) {
  for (int row = first_row; row < block.rows; ++row) {
    const std::byte* pixel =
        block.pixels + std::ptrdiff_t{row} * kProfileTable[kProfile].pixel_bytes;
    std::size_t at = static_cast<std::size_t>(row) * block.row_pixels;
    for (int c = 0; c < columns; ++c, ++at, pixel += block.column_bytes) {
      decode_pixel<kProfile, Channel::kRange>(block, pixel, at);
      decode_pixel<kProfile, Channel::kSignal>(block, pixel, at);
      decode_pixel<kProfile, Channel::kReflectivity>(block, pixel, at);
      decode_pixel<kProfile, Channel::kNearIr>(block, pixel, at);
      decode_pixel<kProfile, Channel::kRange2>(block, pixel, at);
      decode_pixel<kProfile, Channel::kSignal2>(block, pixel, at);
      decode_pixel<kProfile, Channel::kReflectivity2>(block, pixel, at);
    }
  }
}

ColumnBlock block_at(const PacketFormat& format, const std::byte* pixels, int first_column,
                     LidarScan& scan) {
  // Images of channels that the profile lacks are empty: there is nothing to point into.
  const auto at = [&]<class T>(Image<T>& image) {
    return image.empty() ? nullptr : image.data.data() + first_column;
  };
  return {.pixels = pixels,
          .column_bytes = format.column_bytes,
          .row_pixels = static_cast<std::size_t>(format.columns_per_frame),
          .rows = format.pixels_per_column,
          .range_mm = at(scan.range_mm),
          .signal = at(scan.signal),
          .reflectivity = at(scan.reflectivity),
          .near_ir = at(scan.near_ir),
          .range2_mm = at(scan.range2_mm),
          .signal2 = at(scan.signal2),
          .reflectivity2 = at(scan.reflectivity2)};
}

template <std::size_t kProfile, DecoderPath kPath>
int decode_block(const ColumnBlock& block) {
  if constexpr (kPath == DecoderPath::kPortable) {
    return kernel::BlockDecoder<kProfile, PortableVector>::decode(block);
  } else {
    return kernel::avx2_block_decoder(kProfile)(block);
  }
}

template <std::size_t kProfile, DecoderPath kPath>
void decode_columns(const PacketFormat& format, const std::byte* pixels, int count,
                    int first_column, LidarScan& scan) {
  for (int columns = 0; count > 0; count -= columns) {
    columns = std::min(count, kBlockColumns);
    const ColumnBlock block = block_at(format, pixels, first_column, scan);
    const int rows = columns == kBlockColumns ? decode_block<kProfile, kPath>(block) : 0;
    decode_pixels<kProfile>(block, columns, rows);
    first_column += columns;
    pixels += static_cast<std::size_t>(columns) * format.column_bytes;
  }
}

template <DecoderPath kPath, std::size_t... kProfiles>
DecodeColumns pick(LidarProfile profile, std::index_sequence<kProfiles...>) {
  static constexpr std::array<DecodeColumns, sizeof...(kProfiles)> kDecoders{
      &decode_columns<kProfiles, kPath>...};
  return kDecoders[static_cast<std::size_t>(profile)];
}

}  // namespace

DecodeColumns column_decoder(LidarProfile profile, [[maybe_unused]] DecoderPath path) {
  constexpr auto kProfiles = std::make_index_sequence<kProfileTable.size()>();
#ifdef GLINT_AVX2_DECODER
  if (path == DecoderPath::kFastest && __builtin_cpu_supports("avx2") != 0) {
    return pick<DecoderPath::kFastest>(profile, kProfiles);
  }
#endif
  return pick<DecoderPath::kPortable>(profile, kProfiles);
}

}  // namespace glint
