// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "pcap/recording/chunk_file.hpp"
#include "pcap/recording/message.hpp"

namespace glint::recording {

/// First line of a ROS 1 bag, version 2.0.
constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

/// Reads a ROS 1 bag from front to back, so that one without an index, which its recorder did not
/// finish, is read as well.
class Ros1BagReader : public MessageReader {
 public:
  /// @throws InputError if the file cannot be read, is no such bag, or is encrypted.
  explicit Ros1BagReader(const std::filesystem::path& file);

  bool next(Message& message) override;
  [[nodiscard]] std::string problem() const override { return file_.problem(); }

 private:
  /// Fields of a record's header, as far as they are of use.
  struct Header {
    std::uint8_t op = 0;
    std::uint32_t connection = 0;
    std::uint64_t time = 0;  ///< Seconds in the low half, nanoseconds in the high half.
    std::uint64_t index_position = 0;
    std::string_view compression;
    std::string_view topic;
    std::string_view type;
    std::string_view encryptor;
  };
  struct Connection {
    std::string topic;
    std::string type;
  };

  static bool parse_header(ByteSpan bytes, Header& header);
  bool next_in_chunk(Message& message);
  bool next_in_file(Message& message);
  void read_chunk(const Header& header, std::uint32_t size);
  bool take(const Header& header, ByteSpan data, Message& message);
  void add_connection(const Header& header, ByteSpan data);

  ChunkFile file_;
  std::uint64_t index_position_ = 0;  ///< Where the file's index should begin.
  std::map<std::uint32_t, Connection> connections_;
};

}  // namespace glint::recording
