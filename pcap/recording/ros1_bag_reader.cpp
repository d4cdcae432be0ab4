// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/ros1_bag_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "driver/core/error.hpp"

namespace glint::recording {
namespace {

constexpr std::uint8_t kOpMessage = 0x02;
constexpr std::uint8_t kOpBagHeader = 0x03;
constexpr std::uint8_t kOpIndex = 0x04;
constexpr std::uint8_t kOpChunk = 0x05;
constexpr std::uint8_t kOpChunkInfo = 0x06;
constexpr std::uint8_t kOpConnection = 0x07;

/// Headers hold a few names and numbers; those of connections, the topic.
constexpr std::uint32_t kMaxHeaderBytes = 1U << 16U;
constexpr std::size_t kMaxConnections = 1U << 16U;

/// The number that a field's bytes spell; 0 if they are too few.
template <class T>
T number(std::string_view value) {
  return ByteReader(std::as_bytes(std::span(value))).integer<T>();
}

}  // namespace

Ros1BagReader::Ros1BagReader(const std::filesystem::path& file) : file_(file) {
  if (as_text(file_.read(kRos1Magic.size())) != kRos1Magic) {
    throw InputError(
        fmt::format("{} is no ROS 1 bag of version 2.0; bags of older versions are brought to it "
                    "with `rosbag fix`.",
                    file.string()));
  }
  const std::uint32_t header_size = ByteReader(file_.read(4)).integer<std::uint32_t>();
  Header header;
  const bool sound = header_size <= kMaxHeaderBytes &&
                     parse_header(file_.read(header_size), header) && header.op == kOpBagHeader;
  if (!sound) {
    file_.break_off("the bag's header is damaged");
    return;
  }
  if (!header.encryptor.empty()) {
    throw InputError(fmt::format("The bag {} is encrypted ({}); decrypt it with `rosbag decrypt`.",
                                 file.string(), header.encryptor));
  }
  // Recorders write the position last.
  index_position_ = header.index_position;
  if (index_position_ == 0) file_.set_unfinished();
  file_.skip(ByteReader(file_.read(4)).integer<std::uint32_t>());
}

bool Ros1BagReader::next(Message& message) {
  while (true) {
    while (file_.chunk().left() > 0) {
      if (next_in_chunk(message)) return true;
    }
    if (file_.left() == 0 && file_.position() < index_position_) {
      file_.break_off("its index is missing");
    }
    if (file_.broken_off() || file_.left() == 0) return false;
    if (next_in_file(message)) return true;
  }
}

bool Ros1BagReader::parse_header(ByteSpan bytes, Header& header) {
  ByteReader reader(bytes);
  while (reader.left() > 0) {
    const std::string_view field = reader.text(reader.integer<std::uint32_t>());
    const std::size_t equals = field.find('=');
    if (!reader.ok() || equals == std::string_view::npos) return false;
    const std::string_view name = field.substr(0, equals);
    const std::string_view value = field.substr(equals + 1);
    if (name == "op") header.op = number<std::uint8_t>(value);
    if (name == "conn") header.connection = number<std::uint32_t>(value);
    if (name == "time") header.time = number<std::uint64_t>(value);
    if (name == "index_pos") header.index_position = number<std::uint64_t>(value);
    if (name == "compression") header.compression = value;
    if (name == "topic") header.topic = value;
    if (name == "type") header.type = value;
    if (name == "encryptor") header.encryptor = value;
  }
  return true;
}

bool Ros1BagReader::next_in_chunk(Message& message) {
  ByteReader& records = file_.chunk();
  const ByteSpan header_bytes = records.bytes(records.integer<std::uint32_t>());
  const ByteSpan data = records.bytes(records.integer<std::uint32_t>());
  Header header;
  if (!records.ok() || !parse_header(header_bytes, header)) {
    file_.abandon_chunk();
    return false;
  }
  return take(header, data, message);
}

/// Reads a record outside chunks; true if it is a message, as in a chunk that was never closed.
bool Ros1BagReader::next_in_file(Message& message) {
  const std::uint32_t header_size = ByteReader(file_.read(4)).integer<std::uint32_t>();
  if (header_size == 0 || header_size > kMaxHeaderBytes) {
    file_.break_off("no record begins there");
    return false;
  }
  const ByteSpan read = file_.read(header_size);
  const std::vector<std::byte> header_bytes(read.begin(), read.end());
  const std::uint32_t data_size = ByteReader(file_.read(4)).integer<std::uint32_t>();
  Header header;
  if (!parse_header(header_bytes, header)) file_.break_off("no record begins there");
  if (file_.broken_off()) return false;
  switch (header.op) {
    case kOpChunk:
      read_chunk(header, data_size);
      return false;
    case kOpMessage:
    case kOpConnection: {
      if (data_size > kMaxChunkBytes) break;
      const ByteSpan data = file_.read(data_size);
      return !file_.broken_off() && take(header, data, message);
    }
    case kOpIndex:
    case kOpChunkInfo:
      file_.skip(data_size);
      return false;
    default:
      break;
  }
  file_.break_off("no record begins there");
  return false;
}

void Ros1BagReader::read_chunk(const Header& header, std::uint32_t size) {
  const std::optional<Compression> compression = compression_named(header.compression);
  // The size is written when a chunk is closed: of one that was not, all that follows is part, and
  // if it is not packed, its records are as good as any outside chunks.
  const bool unclosed = size == 0 && compression != Compression::kNone;
  const std::uint64_t packed = unclosed ? std::min(file_.left(), kMaxChunkBytes) : size;
  if (!compression || packed > kMaxChunkBytes) {
    file_.count_damaged_chunk();
    file_.skip(packed);
    return;
  }
  const ByteSpan bytes = file_.read(packed);
  if (unclosed) file_.break_off("the last chunk was not closed");
  file_.open_chunk(*compression, bytes);
}

/// Uses a record that messages lie between; true if it is a message.
bool Ros1BagReader::take(const Header& header, ByteSpan data, Message& message) {
  if (header.op == kOpConnection) add_connection(header, data);
  if (header.op != kOpMessage) return false;
  const auto connection = connections_.find(header.connection);
  if (connection == connections_.end()) return false;
  const auto seconds = static_cast<std::int64_t>(header.time & 0xFFFF'FFFFU);
  const auto nanoseconds = static_cast<std::int64_t>(header.time >> 32U);
  message = {connection->second.topic,
             connection->second.type,
             Encoding::kRos1,
             {seconds * kNsPerSecond + nanoseconds},
             data};
  return true;
}

void Ros1BagReader::add_connection(const Header& header, ByteSpan data) {
  Header described;
  if (!parse_header(data, described) || connections_.size() >= kMaxConnections) return;
  // The record names the topic too; the description's is that of the publisher.
  const std::string_view topic = header.topic.empty() ? described.topic : header.topic;
  if (topic.size() > kMaxNameBytes || described.type.size() > kMaxNameBytes) return;
  connections_.try_emplace(header.connection,
                           Connection{std::string(topic), std::string(described.type)});
}

}  // namespace glint::recording
