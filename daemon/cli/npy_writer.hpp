// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace glint::cli {

/// Writes an array as a NumPy .npy file (format 1.0, C order, little-endian).
/// `shape` gives the dimensions; their product is values.size().
/// @throws InputError naming the file if it cannot be written.
template <class T>
void write_npy(const std::filesystem::path& file, const std::vector<std::size_t>& shape,
               std::span<const T> values);

extern template void write_npy(const std::filesystem::path&, const std::vector<std::size_t>&,
                               std::span<const std::uint16_t>);
extern template void write_npy(const std::filesystem::path&, const std::vector<std::size_t>&,
                               std::span<const std::uint32_t>);
extern template void write_npy(const std::filesystem::path&, const std::vector<std::size_t>&,
                               std::span<const std::uint64_t>);
extern template void write_npy(const std::filesystem::path&, const std::vector<std::size_t>&,
                               std::span<const double>);

}  // namespace glint::cli
