// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/npy_writer.hpp"

#include <fmt/format.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <type_traits>

#include "driver/core/error.hpp"

namespace glint::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they lie");

/// Magic, version 1.0, length, and a Python dictionary padded so that the data is aligned to 64.
std::string npy_header(std::string_view type, const std::vector<std::size_t>& shape) {
  constexpr std::size_t kPreambleBytes = 10;
  constexpr std::size_t kAlignment = 64;
  std::string dimensions;
  for (const std::size_t d : shape) dimensions += fmt::format("{},", d);
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, dimensions);
  const std::size_t unpadded = kPreambleBytes + dictionary.size() + 1;
  dictionary.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  dictionary += '\n';
  std::string header = "\x93NUMPY";
  header += '\x01';
  header += '\0';
  header += static_cast<char>(dictionary.size() & 0xFFU);
  header += static_cast<char>(dictionary.size() >> 8U);
  return header + dictionary;
}

template <class T>
std::string numpy_type() {
  return fmt::format("<{}{}", std::is_floating_point_v<T> ? 'f' : 'u', sizeof(T));
}

}  // namespace

template <class T>
void write_npy(const std::filesystem::path& file, const std::vector<std::size_t>& shape,
               std::span<const T> values) {
  std::ofstream out(file, std::ios::binary);
  out << npy_header(numpy_type<T>(), shape);
  const auto bytes = std::as_bytes(values);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out) return;
  throw InputError(fmt::format("{} cannot be written: {}; check the folder and its disk.",
                               file.string(), std::strerror(errno)));
}

template void write_npy(const std::filesystem::path&, const std::vector<std::size_t>&,
                        std::span<const std::uint16_t>);
template void write_npy(const std::filesystem::path&, const std::vector<std::size_t>&,
                        std::span<const std::uint32_t>);
template void write_npy(const std::filesystem::path&, const std::vector<std::size_t>&,
                        std::span<const std::uint64_t>);
template void write_npy(const std::filesystem::path&, const std::vector<std::size_t>&,
                        std::span<const double>);

}  // namespace glint::cli
