// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstdint>

#include "driver/core/profile_layout.hpp"

namespace glint {

/// Offsets inside the packet header; see the sensor manual, "lidar data packet format".
struct HeaderLayout {
  int type_bits;
  int frame_id_offset;
  int init_id_offset;        // 24 bits
  int serial_number_offset;  // 40 bits
  int alert_flags_offset;
};
inline constexpr HeaderLayout kStandardHeader{16, 2, 4, 7, 12};
inline constexpr HeaderLayout kFusaHeader{8, 4, 1, 11, 8};
constexpr const HeaderLayout& header_layout(PacketHeader header) {
  return header == PacketHeader::kFusa ? kFusaHeader : kStandardHeader;
}
constexpr std::size_t kPacketHeaderBytes = 32;
constexpr std::uint16_t kLidarPacketType = 1;
constexpr std::uint16_t kZonePacketType = 3;
constexpr std::size_t kZonePacketBytes = 680;  // whatever the zones
// The same in both.
constexpr int kThermalCountdownOffset = 16;
constexpr int kShotLimitingCountdownOffset = 17;
constexpr int kThermalStateOffset = 18;  // low 4 bits
constexpr int kShotLimitingStateOffset = 19;
constexpr std::size_t kPacketCrcBytes = 8;  // at the very end

// Offsets inside the column header and footer.
constexpr int kColumnTimeOffset = 0;
constexpr int kMeasurementIdOffset = 8;
constexpr int kColumnStatusOffset = 10;  // 16 bits; legacy columns carry 32 bits in their footer
constexpr int kLegacyFrameIdOffset = 10;
constexpr int kLegacyEncoderOffset = 12;
constexpr std::uint32_t kEncoderTicksPerTurn = 90112;

/// A row for packets with header and footer.
constexpr ProfileLayout row(LidarProfile profile, int pixel_bytes,
                            std::array<PixelField, kChannelCount> fields) {
  return {.profile = profile,
          .pixel_bytes = pixel_bytes,
          .packet_header_bytes = 32,
          .column_header_bytes = 12,
          .column_footer_bytes = 0,
          .packet_footer_bytes = 32,
          .fields = fields};
}

/// Every profile, in the order of LidarProfile. Fields are in the order of Channel: range, signal,
/// reflectivity, near-IR, and range, signal, reflectivity of the second return. All start at a
/// byte. Flags, window and zone bits, and colours are left in the packet.
inline constexpr std::array<ProfileLayout, 13> kProfileTable{{
    {.profile = LidarProfile::kLegacy,
     .pixel_bytes = 12,
     .packet_header_bytes = 0,
     .column_header_bytes = 16,
     .column_footer_bytes = 4,
     .packet_footer_bytes = 0,
     .fields = {{{0, 20}, {48, 16}, {32, 16}, {64, 16}, {}, {}, {}}}},
    row(LidarProfile::kRng19Rfl8Sig16Nir16, 12,
        {{{0, 19}, {48, 16}, {32, 8}, {64, 16}, {}, {}, {}}}),
    row(LidarProfile::kRng19Rfl8Sig16Nir16Dual, 16,
        {{{0, 19}, {64, 16}, {24, 8}, {96, 16}, {32, 19}, {80, 16}, {56, 8}}}),
    row(LidarProfile::kRng15Rfl8Nir8, 4, {{{0, 15, 8}, {}, {16, 8}, {24, 8, 16}, {}, {}, {}}}),
    row(LidarProfile::kRng15Rfl8Win8, 4, {{{0, 15, 8}, {}, {16, 8}, {}, {}, {}, {}}}),
    row(LidarProfile::kRng15Rfl8Nir8Dual, 8,
        {{{0, 15, 8}, {}, {16, 8}, {24, 8, 16}, {32, 15, 8}, {}, {48, 8}}}),
    row(LidarProfile::kFusaRng15Rfl8Nir8Dual, 8,
        {{{0, 15, 8}, {}, {16, 8}, {24, 8, 16}, {32, 15, 8}, {}, {48, 8}}}),
    row(LidarProfile::kFiveWordPixel, 20,
        {{{0, 19}, {64, 16}, {24, 8}, {96, 16}, {32, 19}, {80, 16}, {56, 8}}}),
    row(LidarProfile::kRng15Rfl8Nir8Zone16, 8,
        {{{0, 15, 8}, {}, {16, 8}, {24, 8, 16}, {}, {}, {}}}),
    row(LidarProfile::kRng19Rfl8Sig16Nir16Zone16, 12,
        {{{0, 19}, {48, 16}, {32, 8}, {64, 16}, {}, {}, {}}}),
    row(LidarProfile::kRng19Rfl8Sig16Zone16Dual, 16,
        {{{0, 19}, {64, 16}, {24, 8}, {}, {32, 19}, {80, 16}, {56, 8}}}),
    row(LidarProfile::kRng19Rfl8Sig16Nir16Rgb16, 16,
        {{{0, 19}, {32, 16}, {24, 8}, {48, 16}, {}, {}, {}}}),
    row(LidarProfile::kRng19Rfl8Sig16Nir16Rgb16Dual, 20,
        {{{0, 19}, {64, 16}, {24, 8}, {96, 16}, {32, 19}, {80, 16}, {56, 8}}}),
}};

}  // namespace glint
