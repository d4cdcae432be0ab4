// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/input_file.hpp"

#include <fmt/format.h>
#include <sys/types.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "driver/core/error.hpp"

namespace glint::recording {

InputFile::InputFile(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) {
    file_.reset(std::fopen(file.c_str(), "rb"));
    if (file_ == nullptr) error.assign(errno, std::generic_category());
    size_ = error ? 0 : std::filesystem::file_size(file, error);
  } else if (!error) {
    error = std::make_error_code(std::errc::invalid_argument);
  }
  if (error) {
    throw InputError(
        fmt::format("The recording {} cannot be read: {}; check the path and its rights.",
                    file.string(), error.message()));
  }
}

void InputFile::read(std::uint64_t size, std::vector<std::byte>& out) {
  out.resize(static_cast<std::size_t>(std::min(size, left())));
  out.resize(std::fread(out.data(), 1, out.size(), file_.get()));
  position_ += out.size();
  // Shorter than when it was opened: that is its end, then.
  if (std::feof(file_.get()) != 0 || std::ferror(file_.get()) != 0) size_ = position_;
}

bool InputFile::skip(std::uint64_t size) {
  const std::uint64_t leap = std::min(size, left());
  if (::fseeko(file_.get(), static_cast<off_t>(leap), SEEK_CUR) != 0) {
    size_ = position_;
    return false;
  }
  position_ += leap;
  return leap == size;
}

}  // namespace glint::recording
