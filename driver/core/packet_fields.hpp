// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "driver/core/bytes.hpp"
#include "driver/core/crc64.hpp"
#include "driver/core/profile_table.hpp"

// What packets of all types but legacy ones have in common: ids at the front, a CRC at the end. The
// bytes must be at least kPacketHeaderBytes.

namespace glint {

inline std::uint16_t packet_type(const HeaderLayout& layout, const std::byte* packet) {
  return layout.type_bits == 8 ? load<std::uint8_t>(packet) : load<std::uint16_t>(packet);
}

inline std::uint32_t packet_init_id(const HeaderLayout& layout, const std::byte* packet) {
  return load<std::uint32_t>(packet + layout.init_id_offset) & 0xFF'FFFFU;
}

inline std::uint64_t packet_serial_number(const HeaderLayout& layout, const std::byte* packet) {
  return load<std::uint64_t>(packet + layout.serial_number_offset) & 0xFF'FFFF'FFFFU;
}

/// Whether the packet ends with the CRC of all before it. Reads every byte, unless the CRC was left
/// empty: zero is that of no packet (but of one in 2^64).
inline bool packet_crc_matches(std::span<const std::byte> packet) {
  const auto covered = packet.first(packet.size() - kPacketCrcBytes);
  const auto crc = load<std::uint64_t>(covered.data() + covered.size());
  return crc != 0 && crc == crc64(covered);
}

}  // namespace glint
