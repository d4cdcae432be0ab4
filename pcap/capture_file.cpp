// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/capture_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

namespace glint {
namespace {

constexpr std::size_t kHeaderBytes = 24;
constexpr std::size_t kSnapLengthAt = 16;
/// Some packets at a call, and small enough to lie in the cache until they are decoded.
constexpr std::size_t kBufferBytes = std::size_t{1} << 17U;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

/// The file, of which the first bytes are served from a copy that may differ.
struct PatchedFile {
  File file;
  std::array<char, kHeaderBytes> header{};
  std::size_t header_bytes = 0;  ///< Fewer than kHeaderBytes if the file is that short.
  std::size_t header_read = 0;
  /// The stream's, which touches it no more once it has closed the file.
  std::vector<char> buffer = std::vector<char>(kBufferBytes);
};

/// Writes 262144, libpcap's own maximum for Ethernet, over a classic header's snap length.
void raise_snap_length(std::array<char, kHeaderBytes>& header) {
  std::uint32_t magic = 0;
  std::memcpy(&magic, header.data(), sizeof(magic));
  constexpr std::array<char, 4> kLittle{0, 0, 4, 0};
  constexpr std::array<char, 4> kBig{0, 4, 0, 0};
  // As read on a little-endian machine: microsecond and nanosecond files of either byte order.
  const bool little = magic == 0xA1B2C3D4 || magic == 0xA1B23C4D;
  const bool big = magic == 0xD4C3B2A1 || magic == 0x4D3CB2A1;
  if (!little && !big) return;
  std::memcpy(header.data() + kSnapLengthAt, little ? kLittle.data() : kBig.data(), 4);
}

ssize_t read_patched(void* cookie, char* out, std::size_t size) {
  auto& patched = *static_cast<PatchedFile*>(cookie);
  if (patched.header_read < patched.header_bytes) {
    const std::size_t count = std::min(size, patched.header_bytes - patched.header_read);
    std::memcpy(out, patched.header.data() + patched.header_read, count);
    patched.header_read += count;
    return static_cast<ssize_t>(count);
  }
  const std::size_t count = std::fread(out, 1, size, patched.file.get());
  if (count == 0 && std::ferror(patched.file.get()) != 0) return -1;
  return static_cast<ssize_t>(count);
}

int close_patched(void* cookie) {
  delete static_cast<PatchedFile*>(cookie);
  return 0;
}

}  // namespace

std::FILE* open_capture_file(const std::filesystem::path& file) {
  auto patched = std::make_unique<PatchedFile>();
  patched->file.reset(std::fopen(file.c_str(), "rb"));
  if (patched->file == nullptr) return nullptr;
  std::setvbuf(patched->file.get(), nullptr, _IONBF, 0);  // The stream before it has a buffer.
  patched->header_bytes = std::fread(patched->header.data(), 1, kHeaderBytes, patched->file.get());
  if (std::ferror(patched->file.get()) != 0) return nullptr;  // errno says why, e.g. a folder.
  if (patched->header_bytes == kHeaderBytes) raise_snap_length(patched->header);

  std::FILE* const stream =
      fopencookie(patched.get(), "rb", {read_patched, nullptr, nullptr, close_patched});
  if (stream == nullptr) return nullptr;
  // The buffer must be given: glibc takes no notice of the size alone.
  std::setvbuf(stream, patched->buffer.data(), _IOFBF, kBufferBytes);
  static_cast<void>(patched.release());  // Owned by the stream from here on.
  return stream;
}

}  // namespace glint
