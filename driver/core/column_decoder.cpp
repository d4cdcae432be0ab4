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

// One channel of kCount neighbouring pixels of a row. They are gathered before they are stored, for
// bytes may alias anything: a store among the loads would keep the compiler from reordering them.
template <PixelField kField, int kCount, class T>
void decode_row(const std::byte* pixel, std::size_t stride, T* out) {
  if constexpr (kField.present()) {
    std::array<T, kCount> row;
    for (T& value : row) {
      value = static_cast<T>(extract<kField>(pixel));
      pixel += stride;
    }
    std::memcpy(out, row.data(), sizeof row);
  }
}

// Asks for a block at one go; in the order of rows its lines would be missed one after another.
void prefetch(const std::byte* from, std::size_t bytes) {
  constexpr std::size_t kCacheLineBytes = 64;
  for (std::size_t i = 0; i < bytes; i += kCacheLineBytes) __builtin_prefetch(from + i);
}

// Rows outside, columns inside: a packet's columns lie in the cache, so it is the stores into the
// scan that should be contiguous.
template <std::size_t kProfile, int kCount>
void decode_block(const PacketFormat& format, const std::byte* pixel, int first_column,
                  LidarScan& scan) {
  constexpr const ProfileLayout& kLayout = kProfileTable[kProfile];
  const std::size_t stride = format.column_bytes;
  auto at = static_cast<std::size_t>(first_column);
  const auto decode = [&]<Channel kChannel, class T>(Image<T>& image) {
    // Images of channels that the profile lacks are empty: there is nothing to point into.
    if constexpr (kLayout.field(kChannel).present()) {
      decode_row<kLayout.field(kChannel), kCount>(pixel, stride, image.data.data() + at);
    }
  };
  prefetch(pixel, kCount * stride);
  for (int r = 0; r < format.pixels_per_column; ++r) {
    decode.template operator()<Channel::kRange>(scan.range_mm);
    decode.template operator()<Channel::kSignal>(scan.signal);
    decode.template operator()<Channel::kReflectivity>(scan.reflectivity);
    decode.template operator()<Channel::kNearIr>(scan.near_ir);
    decode.template operator()<Channel::kRange2>(scan.range2_mm);
    decode.template operator()<Channel::kSignal2>(scan.signal2);
    decode.template operator()<Channel::kReflectivity2>(scan.reflectivity2);
    pixel += kLayout.pixel_bytes;
    at += static_cast<std::size_t>(format.columns_per_frame);
  }
}

// Nearly all sensors send this many columns a packet; a constant lets the compiler unroll.
constexpr int kUsualColumns = 16;

template <std::size_t kProfile>
void decode_columns(const PacketFormat& format, const std::byte* pixels, int count,
                    int first_column, LidarScan& scan) {
  if (count == kUsualColumns) {
    decode_block<kProfile, kUsualColumns>(format, pixels, first_column, scan);
    return;
  }
  for (int c = 0; c < count; ++c, pixels += format.column_bytes) {
    decode_block<kProfile, 1>(format, pixels, first_column + c, scan);
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
