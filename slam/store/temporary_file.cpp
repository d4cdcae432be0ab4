// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/temporary_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "slam/store/sync.hpp"

namespace glint::slam {
namespace {

void remove_if_there(const std::filesystem::path& file) {
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
}

}  // namespace

// In the target's directory, for only within a file system can a file be renamed.
TemporaryFile::TemporaryFile(std::filesystem::path target)
    : target_(std::move(target)), file_(fmt::format("{}.{}.part", target_.string(), getpid())) {
  remove_if_there(file_);
}

TemporaryFile::~TemporaryFile() { remove_if_there(file_); }

void TemporaryFile::keep() const {
  sync_file(file_);
  std::filesystem::rename(file_, target_);
  sync_directory_of(target_);
}

}  // namespace glint::slam
