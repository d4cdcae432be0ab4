// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/mcap_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "driver/core/error.hpp"

namespace glint::recording {
namespace {

constexpr std::uint8_t kOpFooter = 0x02;
constexpr std::uint8_t kOpSchema = 0x03;
constexpr std::uint8_t kOpChannel = 0x04;
constexpr std::uint8_t kOpMessage = 0x05;
constexpr std::uint8_t kOpChunk = 0x06;
constexpr std::uint8_t kOpDataEnd = 0x0F;

Encoding encoding_named(std::string_view name) {
  if (name == "cdr") return Encoding::kCdr;
  return name == "ros1" ? Encoding::kRos1 : Encoding::kOther;
}

}  // namespace

McapReader::McapReader(const std::filesystem::path& file) : file_(file) {
  if (as_text(file_.read(kMcapMagic.size())) != kMcapMagic) {
    throw InputError(fmt::format("{} is no MCAP file of version 0.", file.string()));
  }
}

bool McapReader::next(Message& message) {
  while (true) {
    while (file_.chunk().left() > 0) {
      if (next_in_chunk(message)) return true;
    }
    if (ended_ || file_.broken_off()) return false;
    if (next_in_file(message)) return true;
  }
}

bool McapReader::next_in_chunk(Message& message) {
  ByteReader& records = file_.chunk();
  const auto opcode = records.integer<std::uint8_t>();
  const ByteSpan content = records.bytes(records.integer<std::uint64_t>());
  if (records.ok()) return take(opcode, content, message);
  file_.abandon_chunk();
  return false;
}

/// Reads a record outside chunks; true if it is a message, as in files without chunks.
bool McapReader::next_in_file(Message& message) {
  if (file_.left() == 0) {
    file_.set_unfinished();
    ended_ = true;
    return false;
  }
  ByteReader prefix(file_.read(9));
  const auto opcode = prefix.integer<std::uint8_t>();
  const auto size = prefix.integer<std::uint64_t>();
  if (opcode == 0) file_.break_off("no record begins there");
  if (file_.broken_off()) return false;
  switch (opcode) {
    case kOpDataEnd:
    case kOpFooter:
      ended_ = true;
      return false;
    case kOpChunk:
      read_chunk(size);
      return false;
    case kOpSchema:
    case kOpChannel:
    case kOpMessage: {
      if (size > kMaxChunkBytes) break;
      const ByteSpan content = file_.read(size);
      return !file_.broken_off() && take(opcode, content, message);
    }
    default:
      break;
  }
  file_.skip(size);
  return false;
}

void McapReader::read_chunk(std::uint64_t size) {
  if (size > kMaxChunkBytes) {
    file_.count_damaged_chunk();
    file_.skip(size);
    return;
  }
  ByteReader chunk(file_.read(size));
  // First and last time, unpacked size, checksum.
  static_cast<void>(chunk.bytes(8 + 8 + 8 + 4));
  const std::optional<Compression> compression =
      compression_named(chunk.text(chunk.integer<std::uint32_t>()));
  const auto packed = chunk.integer<std::uint64_t>();
  if (!compression || !chunk.ok()) {
    if (!file_.broken_off()) file_.count_damaged_chunk();
    return;
  }
  file_.open_chunk(*compression, chunk.bytes(std::min<std::uint64_t>(packed, chunk.left())));
}

/// Uses a record that messages lie between; true if it is a message.
bool McapReader::take(std::uint8_t opcode, ByteSpan content, Message& message) {
  if (opcode == kOpMessage) return take_message(ByteReader(content), message);
  if (opcode == kOpSchema) add_schema(ByteReader(content));
  if (opcode == kOpChannel) add_channel(ByteReader(content));
  return false;
}

bool McapReader::take_message(ByteReader content, Message& message) const {
  const auto channel = channels_.find(content.integer<std::uint16_t>());
  static_cast<void>(content.integer<std::uint32_t>());  // Sequence number.
  const auto log_time_ns = content.integer<std::uint64_t>();
  static_cast<void>(content.integer<std::uint64_t>());  // Time of publishing.
  if (!content.ok() || channel == channels_.end()) return false;
  const auto schema = types_.find(channel->second.schema);
  std::string_view type;
  if (schema != types_.end()) type = schema->second;
  constexpr std::uint64_t kLast_ns = std::numeric_limits<std::int64_t>::max() / 2;
  message = {channel->second.topic,
             type,
             channel->second.encoding,
             {static_cast<std::int64_t>(std::min(log_time_ns, kLast_ns))},
             content.rest()};
  return true;
}

void McapReader::add_schema(ByteReader content) {
  const auto id = content.integer<std::uint16_t>();
  const std::string_view name = content.text(content.integer<std::uint32_t>());
  if (content.ok() && name.size() <= kMaxNameBytes) types_.try_emplace(id, name);
}

void McapReader::add_channel(ByteReader content) {
  const auto id = content.integer<std::uint16_t>();
  const auto schema = content.integer<std::uint16_t>();
  const std::string_view topic = content.text(content.integer<std::uint32_t>());
  const std::string_view encoding = content.text(content.integer<std::uint32_t>());
  if (!content.ok() || topic.size() > kMaxNameBytes) return;
  channels_.try_emplace(id, Channel{schema, std::string(topic), encoding_named(encoding)});
}

}  // namespace glint::recording
