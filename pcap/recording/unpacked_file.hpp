// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <string>

namespace glint::recording {

/// A temporary file that goes away with its object. Thread-compatible.
class TemporaryFile {
 public:
  /// Makes an empty one where the environment's TMPDIR says, else in /tmp.
  /// @throws InputError if that cannot be.
  TemporaryFile();
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A recording that was packed whole with zstd, unpacked to a temporary file.
class UnpackedFile {
 public:
  /// @throws InputError if the file cannot be read, or there is no room for its contents.
  explicit UnpackedFile(const std::filesystem::path& packed);

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }
  /// A sentence if not all could be unpacked; empty otherwise.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  TemporaryFile file_;
  std::string problem_;
};

}  // namespace glint::recording
