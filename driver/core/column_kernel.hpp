// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <utility>

#include "driver/core/profile_table.hpp"

namespace glint::kernel {

/// Columns decoded at a time: as many as nearly all sensors send in a packet.
constexpr int kBlockColumns = 16;

/// Neighbouring columns of a packet, and where in the scan they go. Plain pointers: a file compiled
/// for newer processors must not instantiate a library's inline functions, for the linker might
/// give those to everyone, nor see types of Eigen, which lie in memory as the compiler's flags say.
struct ColumnBlock {
  const std::byte* pixels;   ///< First pixel of the first column.
  std::size_t column_bytes;  ///< From a column to the next.
  std::size_t row_pixels;    ///< From a row of the scan to the next.
  int rows;
  /// Row 0 of each channel at the block's first column; not read where the profile lacks it.
  std::uint32_t* range_mm;
  std::uint16_t* signal;
  std::uint16_t* reflectivity;
  std::uint16_t* near_ir;
  std::uint32_t* range2_mm;
  std::uint16_t* signal2;
  std::uint16_t* reflectivity2;

  /// The pointer of one channel. Always inlined, for the same reason.
  template <Channel kChannel>
  [[nodiscard, gnu::always_inline]] auto out() const {
    if constexpr (kChannel == Channel::kRange) return range_mm;
    if constexpr (kChannel == Channel::kSignal) return signal;
    if constexpr (kChannel == Channel::kReflectivity) return reflectivity;
    if constexpr (kChannel == Channel::kNearIr) return near_ir;
    if constexpr (kChannel == Channel::kRange2) return range2_mm;
    if constexpr (kChannel == Channel::kSignal2) return signal2;
    if constexpr (kChannel == Channel::kReflectivity2) return reflectivity2;
  }
};

/// Decodes the leading rows of a block, as many as make whole tiles, and returns their number.
using DecodeBlock = int (*)(const ColumnBlock& block);

/// The decoder of a profile (its index in the table) for x86 processors with AVX2.
DecodeBlock avx2_block_decoder(std::size_t profile);

/// One word of every column of a block. With 4 lanes vector v holds columns 4 v to 4 v + 3; with 8
/// it holds columns 4 v + 8 to 4 v + 11 behind them, so that packing two gives them in order.
template <class Vector>
struct WordRow {
  static constexpr std::size_t kVectors = kBlockColumns / Vector::kLanes;
  typename Vector::Words part[kVectors];
};

/// The decoder of one profile. Pixels are 32-bit words throughout and fields lie within one, so a
/// packet is a matrix of words to transpose: 16 bytes (4 words) of 4 columns become 4 vectors, each
/// with one word of 4 columns. `Vector` says how that is done on a processor:
///   kLanes               32-bit words in a vector, a multiple of 4.
///   Words                The vector.
///   load(at, stride)     Four words of a column at `at`, each further lane of 128 bits those of
///   the
///                        eighth column after, `stride` bytes from column to column.
///   interleave_low/high  Within each 128 bits: a0 b0 a1 b1, and a2 b2 a3 b3.
///   join_low/high        Within each 128 bits: a0 a1 b0 b1, and a2 a3 b2 b3.
///   store(row, out)      A Row in the order of columns, as 32-bit words or their low halves.
template <std::size_t kProfile, class Vector>
class BlockDecoder {
 public:
  static int decode(const ColumnBlock& block) {
    int row = 0;
    std::size_t offset = 0;
    std::size_t fetched = 0;
    for (; row + kTileRows <= block.rows; row += kTileRows, offset += kTileBytes) {
      for (; fetched < offset + kFetchAheadBytes; fetched += kCacheLineBytes) fetch(block, fetched);
      decode_tile(block, block.pixels + offset, static_cast<std::size_t>(row) * block.row_pixels);
    }
    return row;
  }

 private:
  static constexpr const ProfileLayout& kLayout = kProfileTable[kProfile];
  static constexpr int kQuadBytes = 16;
  static constexpr int kPixelWords = kLayout.pixel_bytes / 4;
  static_assert(kLayout.pixel_bytes % 4 == 0);
  /// The fewest rows that make whole quads of words.
  static constexpr int kTileBytes = std::lcm(kLayout.pixel_bytes, kQuadBytes);
  static constexpr int kTileRows = kTileBytes / kLayout.pixel_bytes;
  static constexpr int kQuads = kTileBytes / kQuadBytes;

  /// Cache lines are asked for this far ahead in each column; 128 to 320 were measured, and make
  /// little difference.
  static constexpr std::size_t kFetchAheadBytes = 192;
  static constexpr std::size_t kCacheLineBytes = 64;

  using Words = typename Vector::Words;
  using Row = WordRow<Vector>;

  /// Asks for one cache line of every column.
  static void fetch(const ColumnBlock& block, std::size_t offset) {
    const std::byte* line = block.pixels + offset;
    for (int c = 0; c < kBlockColumns; ++c, line += block.column_bytes) __builtin_prefetch(line);
  }

  static void decode_tile(const ColumnBlock& block, const std::byte* tile, std::size_t at) {
    [&]<std::size_t... kQuad>(std::index_sequence<kQuad...>) {
      (decode_quad<static_cast<int>(kQuad)>(block, tile, at), ...);
    }
    (std::make_index_sequence<kQuads>());
  }

  template <int kQuad>
  static void decode_quad(const ColumnBlock& block, const std::byte* tile, std::size_t at) {
    Row word[4];
    constexpr int kOffset = kQuad * kQuadBytes;
    transpose(tile + kOffset, block.column_bytes, word);
    decode_word<kQuad * 4>(block, word[0], at);
    decode_word<kQuad * 4 + 1>(block, word[1], at);
    decode_word<kQuad * 4 + 2>(block, word[2], at);
    decode_word<kQuad * 4 + 3>(block, word[3], at);
  }

  static void transpose(const std::byte* from, std::size_t stride, Row (&word)[4]) {
    for (std::size_t v = 0; v < Row::kVectors; ++v, from += 4 * stride) {
      const Words a = Vector::load(from, stride);
      const Words b = Vector::load(from + stride, stride);
      const Words c = Vector::load(from + 2 * stride, stride);
      const Words d = Vector::load(from + 3 * stride, stride);
      const Words ab_low = Vector::interleave_low(a, b);
      const Words ab_high = Vector::interleave_high(a, b);
      const Words cd_low = Vector::interleave_low(c, d);
      const Words cd_high = Vector::interleave_high(c, d);
      word[0].part[v] = Vector::join_low(ab_low, cd_low);
      word[1].part[v] = Vector::join_high(ab_low, cd_low);
      word[2].part[v] = Vector::join_low(ab_high, cd_high);
      word[3].part[v] = Vector::join_high(ab_high, cd_high);
    }
  }

  /// Every channel that lies in word kWord of a tile.
  template <int kWord>
  static void decode_word(const ColumnBlock& block, const Row& words, std::size_t at) {
    at += static_cast<std::size_t>(kWord / kPixelWords) * block.row_pixels;
    constexpr int kFirstBit = kWord % kPixelWords * 32;
    decode_field<Channel::kRange, kFirstBit>(block, words, at);
    decode_field<Channel::kSignal, kFirstBit>(block, words, at);
    decode_field<Channel::kReflectivity, kFirstBit>(block, words, at);
    decode_field<Channel::kNearIr, kFirstBit>(block, words, at);
    decode_field<Channel::kRange2, kFirstBit>(block, words, at);
    decode_field<Channel::kSignal2, kFirstBit>(block, words, at);
    decode_field<Channel::kReflectivity2, kFirstBit>(block, words, at);
  }

  /// One channel, if it lies in the pixel's word that begins at kFirstBit.
  template <Channel kChannel, int kFirstBit>
  static void decode_field(const ColumnBlock& block, const Row& words, std::size_t at) {
    constexpr PixelField kField = kLayout.field(kChannel);
    if constexpr (kField.present() && kField.offset_bits / 32 * 32 == kFirstBit) {
      constexpr int kShift = kField.offset_bits % 32;
      static_assert(kShift + kField.width_bits <= 32 && kField.width_bits < 32);
      constexpr std::uint32_t kMask = (1U << kField.width_bits) - 1U;
      Row values;
      for (std::size_t v = 0; v < Row::kVectors; ++v) {
        values.part[v] = (words.part[v] >> kShift & kMask) * std::uint32_t{kField.scale};
      }
      Vector::store(values, block.out<kChannel>() + at);
    }
  }
};

}  // namespace glint::kernel
