// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace glint::fuzz {

/// Bytes as a file that never touches a disk, for parsers that want a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::byte> contents);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  int descriptor_;
  std::filesystem::path path_;
};

}  // namespace glint::fuzz
