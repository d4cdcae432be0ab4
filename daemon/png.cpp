// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/png.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "driver/core/error.hpp"

namespace glint {

std::vector<std::byte> encode_png(const Image<std::uint8_t>& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.format = PNG_FORMAT_GRAY;
  png.width = static_cast<png_uint_32>(image.cols);
  png.height = static_cast<png_uint_32>(image.rows);
  std::vector<std::byte> encoded(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t size = encoded.size();
  if (png_image_write_to_memory(&png, encoded.data(), &size, 0, image.data.data(), 0, nullptr) ==
      0) {
    throw std::runtime_error(fmt::format("A {}x{} image cannot be encoded as PNG: {}.", image.cols,
                                         image.rows, static_cast<const char*>(png.message)));
  }
  encoded.resize(size);
  return encoded;
}

void write_png(const std::filesystem::path& file, const Image<std::uint8_t>& image) {
  const std::vector<std::byte> encoded = encode_png(image);
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(encoded.data()),
            static_cast<std::streamsize>(encoded.size()));
  out.close();
  if (out) return;
  throw InputError(fmt::format("{} cannot be written: {}; check the folder and its disk.",
                               file.string(), std::strerror(errno)));
}

template <class T>
Image<std::uint8_t> grey_preview(const Image<T>& image) {
  std::vector<T> values;
  std::ranges::copy_if(image.data, std::back_inserter(values), [](T v) { return v > 0; });
  Image<std::uint8_t> grey(image.rows, image.cols);
  if (values.empty()) return grey;
  const auto white_at =
      values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 99 / 100);
  std::ranges::nth_element(values, white_at);
  const double white = static_cast<double>(*white_at);
  std::ranges::transform(image.data, grey.data.begin(), [white](T v) {
    const double level = std::sqrt(std::min(1.0, static_cast<double>(v) / white));
    return static_cast<std::uint8_t>(std::lround(255.0 * level));
  });
  return grey;
}

template Image<std::uint8_t> grey_preview(const Image<std::uint16_t>&);
template Image<std::uint8_t> grey_preview(const Image<std::uint32_t>&);

}  // namespace glint
