// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

#include "pcap/recording/byte_reader.hpp"

namespace glint::recording {

/// The CRC-32 of zlib and IEEE 802.3: reflected polynomial, all ones before and after. Of an empty
/// span: 0. Thread-safe.
std::uint32_t crc32(ByteSpan bytes);

}  // namespace glint::recording
