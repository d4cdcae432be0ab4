// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace glint {

/// What a lidar packet's pixels hold (sensor manual, "lidar data packet format").
enum class LidarProfile {
  kLegacy,
  kRng19Rfl8Sig16Nir16,
  kRng19Rfl8Sig16Nir16Dual,
  kRng15Rfl8Nir8,
  kRng15Rfl8Win8,
  kRng15Rfl8Nir8Dual,
  kFusaRng15Rfl8Nir8Dual,
  kFiveWordPixel,
  kRng15Rfl8Nir8Zone16,
  kRng19Rfl8Sig16Nir16Zone16,
  kRng19Rfl8Sig16Zone16Dual,
  kRng19Rfl8Sig16Nir16Rgb16,
  kRng19Rfl8Sig16Nir16Rgb16Dual,
};

/// Where the header of lidar packets, which legacy ones lack, has its fields.
enum class PacketHeader {
  kStandard,  ///< 16-bit type and frame id.
  kFusa,      ///< 8-bit type, 32-bit frame id, and ids elsewhere.
};

/// Where a field's bits lie in a pixel and how they become a value:
/// value = ((bits >> 0) & mask) * scale. `width_bits` 0 means that the profile lacks the field.
struct PixelField {
  int offset_bits = 0;
  int width_bits = 0;
  int scale = 1;  ///< e.g. 8 for range in steps of 8 mm.
  [[nodiscard]] constexpr bool present() const { return width_bits > 0; }
};

/// The channels a pixel can carry.
enum class Channel { kRange, kSignal, kReflectivity, kNearIr, kRange2, kSignal2, kReflectivity2 };
constexpr std::size_t kChannelCount = 7;

/// One row of the table of profiles.
struct ProfileLayout {
  LidarProfile profile;
  int pixel_bytes;
  int packet_header_bytes;
  int column_header_bytes;
  int column_footer_bytes;
  int packet_footer_bytes;
  std::array<PixelField, kChannelCount> fields;
  [[nodiscard]] constexpr const PixelField& field(Channel c) const {
    return fields[static_cast<std::size_t>(c)];
  }
};

}  // namespace glint
