// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/sync.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "driver/core/error.hpp"

namespace glint::slam {
namespace {

void sync(const std::filesystem::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  // Directories of some network file systems cannot be synchronised, and need not be.
  const bool done = descriptor >= 0 && (::fsync(descriptor) == 0 || errno == EINVAL);
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (done) return;
  throw InputError(fmt::format("cannot bring {} onto the disk: {}; check the disk", path.string(),
                               std::strerror(error)));
}

}  // namespace

void sync_file(const std::filesystem::path& file) { sync(file, O_RDONLY); }

void sync_directory_of(const std::filesystem::path& file) {
  const std::filesystem::path directory = std::filesystem::absolute(file).parent_path();
  sync(directory, O_RDONLY | O_DIRECTORY);
}

}  // namespace glint::slam
