// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/cold_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <new>

namespace glint::slam {
namespace {

// Addresses, no memory: what the file may grow to.
constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 30U;
constexpr std::uint64_t kPage = 4096;

std::uint64_t whole_pages(std::uint64_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }

}  // namespace

std::shared_ptr<ColdFile> ColdFile::create(const std::filesystem::path& directory) {
  const int file = open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0) return nullptr;
  void* const memory = mmap(nullptr, kMostBytes, PROT_READ, MAP_SHARED | MAP_NORESERVE, file, 0);
  if (memory == MAP_FAILED) {
    close(file);
    return nullptr;
  }
  // Tiles are asked for one by one.
  madvise(memory, kMostBytes, MADV_RANDOM);
  return std::shared_ptr<ColdFile>(new ColdFile(file, static_cast<std::byte*>(memory)));
}

ColdFile::~ColdFile() {
  munmap(memory_, kMostBytes);
  close(file_);
}

std::shared_ptr<const std::byte> ColdFile::put(std::span<const std::byte> first,
                                               std::span<const std::byte> second) {
  const std::uint64_t bytes = whole_pages(std::max<std::uint64_t>(1, first.size() + second.size()));
  const std::uint64_t begin = take_room(bytes);
  if (begin == kMostBytes) return nullptr;
  if (!write(first, begin) || !write(second, begin + first.size())) {
    give_back(begin, bytes);
    return nullptr;
  }
  // Its end may lie beyond the file's, where nothing may be read.
  return {memory_ + begin, [self = shared_from_this(), begin, bytes](const std::byte*) {
            self->give_back(begin, bytes);
          }};
}

bool ColdFile::write(std::span<const std::byte> bytes, std::uint64_t at) const {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (written <= 0) return false;
    at += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

// kMostBytes: there is none.
std::uint64_t ColdFile::take_room(std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  const auto room =
      std::ranges::find_if(free_, [&](const auto& hole) { return hole.second >= bytes; });
  std::uint64_t begin = end_;
  if (room != free_.end()) {
    begin = room->first;
    const std::uint64_t left = room->second - bytes;
    free_.erase(room);
    if (left > 0) free_.emplace(begin + bytes, left);
  } else {
    if (end_ + bytes > kMostBytes) return kMostBytes;
    end_ += bytes;
  }
  used_ += bytes;
  return begin;
}

void ColdFile::give_back(std::uint64_t begin, std::uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  used_ -= bytes;
  auto hole = free_.emplace(begin, bytes).first;
  if (const auto next = std::next(hole); next != free_.end() && begin + bytes == next->first) {
    hole->second += next->second;
    free_.erase(next);
  }
  if (hole == free_.begin()) return;
  const auto before = std::prev(hole);
  if (before->first + before->second != begin) return;
  before->second += hole->second;
  free_.erase(hole);
}

void ColdFile::rest() const { madvise(memory_, kMostBytes, MADV_DONTNEED); }

std::uint64_t ColdFile::bytes() const {
  const std::lock_guard lock(mutex_);
  return used_;
}

}  // namespace glint::slam
