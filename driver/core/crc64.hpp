// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace glint {

/// The CRC that ends a packet's footer: reflected ECMA-182 polynomial, all ones before and after
/// ("CRC-64/XZ"). Of an empty span: 0.
std::uint64_t crc64(std::span<const std::byte> bytes);

}  // namespace glint
