// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "tests/fuzz/memory_file.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "tests/fuzz/require.hpp"

namespace glint::fuzz {

MemoryFile::MemoryFile(std::span<const std::byte> contents)
    : descriptor_(memfd_create("glint-fuzz", MFD_CLOEXEC)),
      path_(fmt::format("/proc/self/fd/{}", descriptor_)) {
  require(descriptor_ >= 0, "a file in memory can be made");
  const auto size = static_cast<ssize_t>(contents.size());
  require(write(descriptor_, contents.data(), contents.size()) == size, "it can be written");
}

MemoryFile::~MemoryFile() { close(descriptor_); }

}  // namespace glint::fuzz
