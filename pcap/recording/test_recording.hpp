// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pcap/recording/inflater.hpp"

namespace glint::recording::test {

using Buffer = std::vector<std::byte>;

/// A message to be recorded.
struct TestMessage {
  enum class Kind { kPacket, kText, kOther };
  Kind kind = Kind::kPacket;
  std::string topic;
  std::int64_t time_ns = 0;
  Buffer body;  ///< The packet, the text, or for kOther the message as it is.

  friend bool operator==(const TestMessage&, const TestMessage&) = default;
};

struct WriteOptions {
  Compression compression = Compression::kNone;  ///< Of chunks.
  int messages_per_chunk = 7;                    ///< 0: no chunks.
  bool finished = true;                          ///< False: as a recorder leaves it that dies.
  bool big_endian = false;                       ///< CDR's byte order.
  bool pack_messages = false;                    ///< Each with zstd.
};

/// Bytes that a string spells, and the other way about.
Buffer to_bytes(std::string_view text);
std::string to_string(const Buffer& bytes);

Buffer compress(Compression compression, const Buffer& bytes);

/// Collects integers (little-endian unless told) and bytes.
class ByteWriter {
 public:
  template <class T>
  ByteWriter& integer(T value, bool big_endian = false) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      const std::size_t place = big_endian ? sizeof(T) - 1 - i : i;
      bytes_.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * place)));
    }
    return *this;
  }
  ByteWriter& bytes(const Buffer& bytes) {
    for (const std::byte byte : bytes) bytes_.push_back(byte);
    return *this;
  }
  ByteWriter& text(std::string_view text) { return bytes(to_bytes(text)); }
  [[nodiscard]] const Buffer& buffer() const { return bytes_; }

 private:
  Buffer bytes_;
};

/// A message as ROS 1 and as ROS 2 serialise it.
Buffer ros1_serialised(const TestMessage& message);
Buffer cdr_serialised(const TestMessage& message, const WriteOptions& options);

Buffer ros1_bag(const std::vector<TestMessage>& messages, const WriteOptions& options = {});
/// With CDR messages, as in a ROS 2 bag.
Buffer mcap(const std::vector<TestMessage>& messages, const WriteOptions& options = {});
/// Writes a ROS 2 bag's SQLite file.
void write_sqlite(const std::filesystem::path& file, const std::vector<TestMessage>& messages,
                  const WriteOptions& options = {});
/// An OSF file's block of metadata, its size in front and without its checksum: sensors with
/// these metadata, and a stream of scans for each.
Buffer osf_metadata(const std::vector<std::string>& sensors);
/// An OSF file of these sensors with empty streams; unfinished, one without its metadata.
Buffer osf(const std::vector<std::string>& sensors, bool finished = true);

void save(const std::filesystem::path& file, const Buffer& bytes);
Buffer load_file(const std::filesystem::path& file);

/// Reads all messages of interest back.
std::vector<TestMessage> read_messages(const std::filesystem::path& path,
                                       std::string* problem = nullptr);

}  // namespace glint::recording::test
