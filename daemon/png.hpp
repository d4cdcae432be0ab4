// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "driver/core/lidar_scan.hpp"

namespace glint {

/// Encodes an 8-bit grey image as PNG, in memory. Thread-safe.
/// @throws std::runtime_error if the image is empty or memory runs out.
std::vector<std::byte> encode_png(const Image<std::uint8_t>& image);

/// Writes an 8-bit grey image as a PNG file. @throws InputError if the file cannot be written.
void write_png(const std::filesystem::path& file, const Image<std::uint8_t>& image);

/// Grey levels for looking at: 0 stays black, the 99th percentile of the other pixels is white, the
/// square root between, so that both near and far returns show.
template <class T>
Image<std::uint8_t> grey_preview(const Image<T>& image);

extern template Image<std::uint8_t> grey_preview(const Image<std::uint16_t>&);
extern template Image<std::uint8_t> grey_preview(const Image<std::uint32_t>&);

}  // namespace glint
