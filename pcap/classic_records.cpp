// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/classic_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace glint {
namespace {

constexpr std::size_t kFileHeaderBytes = 24;
constexpr std::size_t kRecordHeaderBytes = 16;
/// libpcap's own maximum for Ethernet; a record said to be longer is damage.
constexpr std::size_t kMaxRecordBytes = 262'144;
/// Some packets at a call, and small enough to lie in the cache until they are decoded.
constexpr std::size_t kBufferBytes = kMaxRecordBytes + kRecordHeaderBytes;

constexpr std::uint32_t kMicrosecondMagic = 0xA1B2C3D4;
constexpr std::uint32_t kNanosecondMagic = 0xA1B23C4D;

template <typename T>
T load_as(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

}  // namespace

std::optional<ClassicRecords> ClassicRecords::open(const std::filesystem::path& path) {
  File file(std::fopen(path.c_str(), "rb"));
  if (file == nullptr) return std::nullopt;
  std::setvbuf(file.get(), nullptr, _IONBF, 0);  // The buffer of records is enough.
  std::array<std::uint8_t, kFileHeaderBytes> header{};
  if (std::fread(header.data(), 1, header.size(), file.get()) != header.size()) return std::nullopt;

  const auto magic = load_as<std::uint32_t>(header.data());
  const bool is_swapped =
      __builtin_bswap32(magic) == kMicrosecondMagic || __builtin_bswap32(magic) == kNanosecondMagic;
  const std::uint32_t kind = is_swapped ? __builtin_bswap32(magic) : magic;
  if (kind != kMicrosecondMagic && kind != kNanosecondMagic) return std::nullopt;
  const auto version_part = [&](std::size_t at) {
    const auto value = load_as<std::uint16_t>(header.data() + at);
    return is_swapped ? __builtin_bswap16(value) : value;
  };
  if (version_part(4) != 2 || version_part(6) != 4) return std::nullopt;
  return ClassicRecords(std::move(file), is_swapped, kind == kNanosecondMagic);
}

ClassicRecords::ClassicRecords(File file, bool is_swapped, bool has_nanoseconds)
    : file_(std::move(file)),
      is_swapped_(is_swapped),
      ns_per_tick_(has_nanoseconds ? 1 : 1000),
      buffer_(kBufferBytes) {}

std::uint32_t ClassicRecords::load(std::size_t at) const {
  const auto value = load_as<std::uint32_t>(buffer_.data() + begin_ + at);
  return is_swapped_ ? __builtin_bswap32(value) : value;
}

bool ClassicRecords::have(std::size_t count) {
  if (end_ - begin_ >= count) return true;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  end_ += std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_.get());
  return end_ >= count;
}

const CaptureRecord* ClassicRecords::next() {
  if (!fault_.empty()) return nullptr;
  if (!have(kRecordHeaderBytes)) {
    if (std::ferror(file_.get()) != 0) {
      fault_ = fmt::format("reading failed: {}", std::strerror(errno));
    } else if (end_ != begin_) {
      fault_ = "the file ends within a record's header";
    }
    return nullptr;
  }
  // Seconds are unsigned since 2038 came into view.
  const std::int64_t seconds = load(0);
  const std::int64_t ticks = load(4);
  const std::size_t size = load(8);
  if (size > kMaxRecordBytes) {
    fault_ = fmt::format("a record claims to have {} bytes", size);
    return nullptr;
  }
  if (!have(kRecordHeaderBytes + size)) {
    fault_ = "the file ends within a record";
    return nullptr;
  }
  record_ = {{seconds * kNsPerSecond + ticks * ns_per_tick_},
             Bytes(buffer_).subspan(begin_ + kRecordHeaderBytes, size)};
  begin_ += kRecordHeaderBytes + size;
  return &record_;
}

}  // namespace glint
