// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

namespace glint::slam {
namespace {

namespace fs = std::filesystem;

void* map(const fs::path& file, std::size_t size) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  void* address =
      descriptor < 0 ? MAP_FAILED : ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  const std::error_code error(errno, std::generic_category());
  if (descriptor >= 0) ::close(descriptor);
  if (address == MAP_FAILED) throw fs::filesystem_error("cannot be read", file, error);
  return address;
}

}  // namespace

MappedFile::MappedFile(const fs::path& file) {
  const std::size_t size = fs::file_size(file);
  // Nothing cannot be mapped.
  if (size > 0) bytes_ = {static_cast<std::byte*>(map(file, size)), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(bytes_.data(), bytes_.size());
}

}  // namespace glint::slam
