// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>

namespace glint::slam {

/// A file under another name until it is whole; goes away unless keep() gives it its own.
class TemporaryFile {
 public:
  /// The file that `target` will be; nothing is made yet.
  explicit TemporaryFile(std::filesystem::path target);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return file_; }
  /// Waits until it is on the disk, then puts it in place of `target`: at every moment one of them
  /// is there whole. @throws std::filesystem::filesystem_error, or InputError from sync.hpp.
  void keep() const;

 private:
  std::filesystem::path target_;
  std::filesystem::path file_;
};

}  // namespace glint::slam
