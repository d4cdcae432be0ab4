// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/column_decoder.hpp"

#include <array>
#include <utility>

#include "driver/core/bytes.hpp"
#include "driver/core/profile_table.hpp"

namespace glint {
namespace {

// A field of a pixel, its place and width known to the compiler.
template <PixelField kField>
std::uint32_t extract(const std::byte* pixel) {
  static_assert(kField.offset_bits % 8 == 0 && kField.width_bits <= 24);
  constexpr std::uint32_t kMask = (1U << kField.width_bits) - 1U;
  const std::byte* from = pixel + kField.offset_bits / 8;
  std::uint32_t bits = 0;
  if constexpr (kField.width_bits <= 8) {
    bits = load<std::uint8_t>(from);
  } else if constexpr (kField.width_bits <= 16) {
    bits = load<std::uint16_t>(from) & kMask;
  } else {
    // Fields this wide begin a 32-bit word in every profile.
    bits = load<std::uint32_t>(from) & kMask;
  }
  return bits * static_cast<std::uint32_t>(kField.scale);
}

template <PixelField kField, class T>
void decode_row(const std::byte* pixel, std::size_t stride, int count, T* out) {
  if constexpr (kField.present()) {
    for (int c = 0; c < count; ++c, pixel += stride)
      out[c] = static_cast<T>(extract<kField>(pixel));
  }
}

// Rows outside, columns inside: a packet's columns lie in the cache, so it is the stores into the
// scan that should be contiguous.
template <std::size_t kProfile>
void decode_columns(const PacketFormat& format, const std::byte* pixels, int count,
                    int first_column, LidarScan& scan) {
  constexpr ProfileLayout kLayout = kProfileTable[kProfile];
  const std::size_t stride = format.column_bytes;
  const std::byte* pixel = pixels;
  auto at = static_cast<std::size_t>(first_column);
  for (int r = 0; r < format.pixels_per_column; ++r) {
    decode_row<kLayout.field(Channel::kRange)>(pixel, stride, count,
                                               scan.range_mm.data.data() + at);
    decode_row<kLayout.field(Channel::kSignal)>(pixel, stride, count, scan.signal.data.data() + at);
    decode_row<kLayout.field(Channel::kReflectivity)>(pixel, stride, count,
                                                      scan.reflectivity.data.data() + at);
    decode_row<kLayout.field(Channel::kNearIr)>(pixel, stride, count,
                                                scan.near_ir.data.data() + at);
    decode_row<kLayout.field(Channel::kRange2)>(pixel, stride, count,
                                                scan.range2_mm.data.data() + at);
    decode_row<kLayout.field(Channel::kSignal2)>(pixel, stride, count,
                                                 scan.signal2.data.data() + at);
    decode_row<kLayout.field(Channel::kReflectivity2)>(pixel, stride, count,
                                                       scan.reflectivity2.data.data() + at);
    pixel += kLayout.pixel_bytes;
    at += static_cast<std::size_t>(format.columns_per_frame);
  }
}

template <std::size_t... kProfiles>
constexpr std::array<DecodeColumns, sizeof...(kProfiles)> all_decoders(
    std::index_sequence<kProfiles...>) {
  return {&decode_columns<kProfiles>...};
}

}  // namespace

DecodeColumns column_decoder(LidarProfile profile) {
  static constexpr auto kDecoders = all_decoders(std::make_index_sequence<kProfileTable.size()>());
  return kDecoders[static_cast<std::size_t>(profile)];
}

}  // namespace glint
