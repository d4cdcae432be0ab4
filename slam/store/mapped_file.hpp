// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace glint::slam {

/// A file's bytes, read as they are asked for. Immutable, so any thread; the file must not shrink
/// meanwhile.
class MappedFile {
 public:
  /// @throws std::filesystem::filesystem_error.
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<std::byte> bytes_;
};

}  // namespace glint::slam
