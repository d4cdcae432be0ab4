// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>

#include "driver/core/packet_format.hpp"

namespace glint {

// Offsets inside the packet header, the column header and the column footer; see the sensor manual,
// "lidar data packet format".
constexpr int kPacketTypeOffset = 0;
constexpr int kFrameIdOffset = 2;
constexpr int kInitIdOffset = 4;        // 24 bits
constexpr int kSerialNumberOffset = 7;  // 40 bits
constexpr std::uint16_t kLidarPacketType = 1;
constexpr int kColumnTimeOffset = 0;
constexpr int kMeasurementIdOffset = 8;
constexpr int kColumnStatusOffset = 10;  // 16 bits; legacy columns carry 32 bits in their footer
constexpr int kLegacyFrameIdOffset = 10;
constexpr int kLegacyEncoderOffset = 12;
constexpr std::uint32_t kEncoderTicksPerTurn = 90112;

/// Every profile, in the order of LidarProfile. Fields are in the order of Channel: range, signal,
/// reflectivity, near-IR, and range, signal, reflectivity of the second return. All start at a
/// byte.
inline constexpr std::array<ProfileLayout, 4> kProfileTable{{
    {.profile = LidarProfile::kLegacy,
     .pixel_bytes = 12,
     .packet_header_bytes = 0,
     .column_header_bytes = 16,
     .column_footer_bytes = 4,
     .packet_footer_bytes = 0,
     .fields = {{{0, 20}, {48, 16}, {32, 16}, {64, 16}, {}, {}, {}}}},
    {.profile = LidarProfile::kRng19Rfl8Sig16Nir16,
     .pixel_bytes = 12,
     .packet_header_bytes = 32,
     .column_header_bytes = 12,
     .column_footer_bytes = 0,
     .packet_footer_bytes = 32,
     .fields = {{{0, 19}, {48, 16}, {32, 8}, {64, 16}, {}, {}, {}}}},
    {.profile = LidarProfile::kRng19Rfl8Sig16Nir16Dual,
     .pixel_bytes = 16,
     .packet_header_bytes = 32,
     .column_header_bytes = 12,
     .column_footer_bytes = 0,
     .packet_footer_bytes = 32,
     .fields = {{{0, 19}, {64, 16}, {24, 8}, {96, 16}, {32, 19}, {80, 16}, {56, 8}}}},
    {.profile = LidarProfile::kRng15Rfl8Nir8,
     .pixel_bytes = 4,
     .packet_header_bytes = 32,
     .column_header_bytes = 12,
     .column_footer_bytes = 0,
     .packet_footer_bytes = 32,
     .fields = {{{0, 15, 8}, {}, {16, 8}, {24, 8, 16}, {}, {}, {}}}},
}};

}  // namespace glint
