// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/core/time.hpp"
#include "pcap/byte_order.hpp"

namespace glint {

/// A record of a capture file. Non-owning: valid until its reader's next call.
struct CaptureRecord {
  HostTime time;
  Bytes bytes;  ///< As captured: from the link header on.
};

/// The records of a classic pcap file, version 2.4, of either byte order, with times in
/// microseconds or nanoseconds (format: pcap-savefile(5)). They are handed out where the file was
/// read to, which is what makes reading as fast as the copy out of the page cache; libpcap copies
/// each once more. Nor does it matter what snap length the header announces: captures exist whose
/// records hold whole reassembled datagrams under a header of, say, 1500 bytes. Thread-compatible.
class ClassicRecords {
 public:
  /// Null if the file cannot be read or is of another format, e.g. pcapng: libpcap's to judge.
  static std::optional<ClassicRecords> open(const std::filesystem::path& file);

  /// The next record; null at the end of the file, or where it makes no sense any more.
  const CaptureRecord* next();
  /// Why the records ended before the file did, as part of a sentence; empty if they did not.
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Closer>;

  ClassicRecords(File file, bool is_swapped, bool has_nanoseconds);
  [[nodiscard]] std::uint32_t load(std::size_t at) const;
  /// Reads on until `count` bytes are there from begin_ on. False if the file ends before.
  bool have(std::size_t count);

  File file_;
  bool is_swapped_;  ///< Of the other byte order than this machine's.
  std::int64_t ns_per_tick_;
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;  ///< What is read, but not yet handed out: [begin_, end_) of the buffer.
  std::size_t end_ = 0;
  CaptureRecord record_{};
  std::string fault_;
};

}  // namespace glint
