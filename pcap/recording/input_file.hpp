// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

namespace glint::recording {

/// A regular file that is read from front to back, with leaps. Thread-compatible.
class InputFile {
 public:
  /// @throws InputError if the file is missing, no regular file, or may not be read.
  explicit InputFile(const std::filesystem::path& file);

  /// Reads `size` bytes into `out`, in place of what it held; fewer only at the end of the file,
  /// so that a size that lies takes no memory.
  void read(std::uint64_t size, std::vector<std::byte>& out);
  /// Leaps over `size` bytes, but not past the end; false if there are fewer.
  bool skip(std::uint64_t size);

  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// As it was when the file was opened.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] std::uint64_t left() const { return size_ - position_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace glint::recording
