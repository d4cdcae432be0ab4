// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "pcap/recording/chunk_file.hpp"
#include "pcap/recording/message.hpp"

namespace glint::recording {

/// First bytes of an MCAP file, version 0.
constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

/// Reads an MCAP file from front to back, so that one without a summary, which its recorder did not
/// finish, is read as well. The usual storage of ROS 2 bags since 2023.
class McapReader : public MessageReader {
 public:
  /// @throws InputError if the file cannot be read or is no MCAP file.
  explicit McapReader(const std::filesystem::path& file);

  bool next(Message& message) override;
  [[nodiscard]] std::string problem() const override { return file_.problem(); }

 private:
  struct Channel {
    std::uint16_t schema = 0;
    std::string topic;
    Encoding encoding = Encoding::kOther;
  };

  bool next_in_chunk(Message& message);
  bool next_in_file(Message& message);
  void read_chunk(std::uint64_t size);
  bool take(std::uint8_t opcode, ByteSpan content, Message& message);
  bool take_message(ByteReader content, Message& message) const;
  void add_schema(ByteReader content);
  void add_channel(ByteReader content);

  ChunkFile file_;
  bool ended_ = false;
  std::map<std::uint16_t, std::string> types_;  ///< By schema.
  std::map<std::uint16_t, Channel> channels_;
};

}  // namespace glint::recording
