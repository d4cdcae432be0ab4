// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace glint {

/// The CRC that ends a packet's footer: reflected ECMA-182 polynomial, all ones before and after
/// ("CRC-64/XZ"). Of an empty span: 0. Multiplies without carries where the processor can.
std::uint64_t crc64(std::span<const std::byte> bytes);

/// The same by tables, on any processor.
std::uint64_t crc64_portable(std::span<const std::byte> bytes);

}  // namespace glint
