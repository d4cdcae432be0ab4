// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/test_recording.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <stdexcept>

#include "pcap/recording/message_decoder.hpp"
#include "pcap/recording/message_files.hpp"

namespace glint::recording::test {
namespace {

using Kind = TestMessage::Kind;

void require(bool ok, const char* what) {
  if (!ok) throw std::runtime_error(what);
}

std::string ros1_type(Kind kind) {
  if (kind == Kind::kPacket) return "ouster_ros/PacketMsg";
  return kind == Kind::kText ? "std_msgs/String" : "sensor_msgs/PointCloud2";
}

std::string ros2_type(Kind kind) {
  if (kind == Kind::kPacket) return "ouster_sensor_msgs/msg/PacketMsg";
  return kind == Kind::kText ? "std_msgs/msg/String" : "sensor_msgs/msg/PointCloud2";
}

/// Topics by number, in order of appearance.
std::map<std::string, std::uint32_t> number_topics(const std::vector<TestMessage>& messages) {
  std::map<std::string, std::uint32_t> ids;
  for (const TestMessage& message : messages) {
    ids.try_emplace(message.topic, static_cast<std::uint32_t>(ids.size()));
  }
  return ids;
}

using Fields = std::vector<std::pair<std::string, Buffer>>;

template <class T>
Buffer number(T value) {
  return ByteWriter().integer(value).buffer();
}

Buffer ros1_fields(const Fields& fields) {
  ByteWriter out;
  for (const auto& [name, value] : fields) {
    out.integer(static_cast<std::uint32_t>(name.size() + 1 + value.size()));
    out.text(name).text("=").bytes(value);
  }
  return out.buffer();
}

Buffer ros1_record(const Fields& fields, const Buffer& data) {
  const Buffer header = ros1_fields(fields);
  return ByteWriter()
      .integer(static_cast<std::uint32_t>(header.size()))
      .bytes(header)
      .integer(static_cast<std::uint32_t>(data.size()))
      .bytes(data)
      .buffer();
}

const char* name_of(Compression compression, const char* none) {
  if (compression == Compression::kBzip2) return "bz2";
  if (compression == Compression::kLz4) return "lz4";
  return compression == Compression::kZstd ? "zstd" : none;
}

Buffer ros1_chunk(const Buffer& records, const WriteOptions& options) {
  const Buffer packed = compress(options.compression, records);
  return ros1_record({{"op", number<std::uint8_t>(5)},
                      {"compression", to_bytes(name_of(options.compression, "none"))},
                      {"size", number(static_cast<std::uint32_t>(records.size()))}},
                     packed);
}

Buffer mcap_record(std::uint8_t opcode, const Buffer& content) {
  return ByteWriter()
      .integer(opcode)
      .integer(static_cast<std::uint64_t>(content.size()))
      .bytes(content)
      .buffer();
}

Buffer mcap_text(std::string_view text) {
  return ByteWriter().integer(static_cast<std::uint32_t>(text.size())).text(text).buffer();
}

Buffer mcap_chunk(const Buffer& records, const WriteOptions& options) {
  const Buffer packed = compress(options.compression, records);
  return mcap_record(6, ByteWriter()
                            .integer(std::uint64_t{0})
                            .integer(std::uint64_t{0})
                            .integer(static_cast<std::uint64_t>(records.size()))
                            .integer(std::uint32_t{0})
                            .bytes(mcap_text(name_of(options.compression, "")))
                            .integer(static_cast<std::uint64_t>(packed.size()))
                            .bytes(packed)
                            .buffer());
}

/// Joins what `write` makes of each message, in chunks if there are to be some.
Buffer in_chunks(const std::vector<TestMessage>& messages, const WriteOptions& options,
                 const std::function<Buffer(const TestMessage&)>& write,
                 const std::function<Buffer(const Buffer&)>& chunk) {
  ByteWriter out;
  ByteWriter records;
  int count = 0;
  for (const TestMessage& message : messages) {
    records.bytes(write(message));
    if (++count < options.messages_per_chunk && &message != &messages.back()) continue;
    out.bytes(options.messages_per_chunk > 0 ? chunk(records.buffer()) : records.buffer());
    records = {};
    count = 0;
  }
  return out.buffer();
}

}  // namespace

Buffer to_bytes(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string to_string(const Buffer& bytes) { return std::string(as_text(bytes)); }

Buffer compress(Compression compression, const Buffer& bytes) {
  if (compression == Compression::kNone) return bytes;
  Buffer out(bytes.size() + bytes.size() / 50 + 100'000);
  std::size_t size = 0;
  if (compression == Compression::kBzip2) {
    auto room = static_cast<unsigned>(out.size());
    std::string source = to_string(bytes);
    const int status =
        BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(out.data()), &room, source.data(),
                                 static_cast<unsigned>(source.size()), 1, 0, 0);
    require(status == BZ_OK, "bz2");
    size = room;
  } else if (compression == Compression::kLz4) {
    LZ4F_preferences_t preferences{};
    preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;  // As ROS does.
    size = LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), &preferences);
    require(LZ4F_isError(size) == 0, "lz4");
  } else {
    size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1);
    require(ZSTD_isError(size) == 0, "zstd");
  }
  out.resize(size);
  return out;
}

Buffer ros1_serialised(const TestMessage& message) {
  if (message.kind == Kind::kOther) return message.body;
  return ByteWriter()
      .integer(static_cast<std::uint32_t>(message.body.size()))
      .bytes(message.body)
      .buffer();
}

Buffer cdr_serialised(const TestMessage& message, const WriteOptions& options) {
  if (message.kind == Kind::kOther) return message.body;
  const bool text = message.kind == Kind::kText;
  ByteWriter out;
  out.integer<std::uint16_t>(options.big_endian ? 0 : 1, true).integer<std::uint16_t>(0);
  out.integer(static_cast<std::uint32_t>(message.body.size() + (text ? 1 : 0)), options.big_endian);
  out.bytes(message.body);
  if (text) out.integer(std::uint8_t{0});
  return options.pack_messages ? compress(Compression::kZstd, out.buffer()) : out.buffer();
}

Buffer ros1_bag(const std::vector<TestMessage>& messages, const WriteOptions& options) {
  const auto ids = number_topics(messages);
  std::map<std::string, bool> declared;
  const auto connection = [&](const TestMessage& message) {
    return ros1_record({{"op", number<std::uint8_t>(7)},
                        {"topic", to_bytes(message.topic)},
                        {"conn", number(ids.at(message.topic))}},
                       ros1_fields({{"topic", to_bytes(message.topic)},
                                    {"type", to_bytes(ros1_type(message.kind))},
                                    {"md5sum", to_bytes("*")}}));
  };
  const auto write = [&](const TestMessage& message) {
    ByteWriter out;
    if (!declared[message.topic]) out.bytes(connection(message));
    declared[message.topic] = true;
    const Buffer time = ByteWriter()
                            .integer(static_cast<std::uint32_t>(message.time_ns / 1'000'000'000))
                            .integer(static_cast<std::uint32_t>(message.time_ns % 1'000'000'000))
                            .buffer();
    return out
        .bytes(ros1_record({{"op", number<std::uint8_t>(2)},
                            {"conn", number(ids.at(message.topic))},
                            {"time", time}},
                           ros1_serialised(message)))
        .buffer();
  };
  const auto chunk = [&](const Buffer& records) {
    return ByteWriter()
        .bytes(ros1_chunk(records, options))
        .bytes(ros1_record({{"op", number<std::uint8_t>(4)}}, Buffer(24)))  // An index.
        .buffer();
  };
  const Buffer chunks = in_chunks(messages, options, write, chunk);
  const auto start = [](std::uint64_t index_position) {
    return ByteWriter()
        .text("#ROSBAG V2.0\n")
        .bytes(ros1_record({{"op", number<std::uint8_t>(3)}, {"index_pos", number(index_position)}},
                           Buffer(4027)))
        .buffer();
  };
  const std::uint64_t index_position = start(0).size() + chunks.size();
  ByteWriter out;
  out.bytes(start(options.finished ? index_position : 0)).bytes(chunks);
  if (options.finished) out.bytes(ros1_record({{"op", number<std::uint8_t>(6)}}, Buffer(16)));
  return out.buffer();
}

Buffer mcap(const std::vector<TestMessage>& messages, const WriteOptions& options) {
  const auto ids = number_topics(messages);
  std::map<std::string, bool> declared;
  const auto declare = [&](const TestMessage& message) {
    const auto id = static_cast<std::uint16_t>(ids.at(message.topic));
    const auto schema = static_cast<std::uint16_t>(id + 1);  // 0 means none.
    return ByteWriter()
        .bytes(mcap_record(3, ByteWriter()
                                  .integer(schema)
                                  .bytes(mcap_text(ros2_type(message.kind)))
                                  .bytes(mcap_text("ros2msg"))
                                  .bytes(mcap_text("uint8[] buf\n"))
                                  .buffer()))
        .bytes(mcap_record(4, ByteWriter()
                                  .integer(id)
                                  .integer(schema)
                                  .bytes(mcap_text(message.topic))
                                  .bytes(mcap_text("cdr"))
                                  .integer(std::uint32_t{0})
                                  .buffer()))
        .buffer();
  };
  const auto write = [&](const TestMessage& message) {
    ByteWriter out;
    if (!declared[message.topic]) out.bytes(declare(message));
    declared[message.topic] = true;
    const auto time = static_cast<std::uint64_t>(message.time_ns);
    return out
        .bytes(mcap_record(5, ByteWriter()
                                  .integer(static_cast<std::uint16_t>(ids.at(message.topic)))
                                  .integer(std::uint32_t{0})
                                  .integer(time)
                                  .integer(time)
                                  .bytes(cdr_serialised(message, options))
                                  .buffer()))
        .buffer();
  };
  const auto chunk = [&](const Buffer& records) {
    return ByteWriter()
        .bytes(mcap_chunk(records, options))
        .bytes(mcap_record(7, Buffer(22)))
        .buffer();
  };
  ByteWriter out;
  out.text("\x89MCAP0\r\n")
      .bytes(mcap_record(1, ByteWriter().bytes(mcap_text("ros2")).bytes(mcap_text("")).buffer()));
  out.bytes(in_chunks(messages, options, write, chunk));
  if (options.finished) {
    out.bytes(mcap_record(15, Buffer(4))).bytes(mcap_record(2, Buffer(20))).text("\x89MCAP0\r\n");
  }
  return out.buffer();
}

void write_sqlite(const std::filesystem::path& file, const std::vector<TestMessage>& messages,
                  const WriteOptions& options) {
  sqlite3* database = nullptr;
  require(sqlite3_open(file.c_str(), &database) == SQLITE_OK, "open");
  const auto run = [&](const char* sql) {
    require(sqlite3_exec(database, sql, nullptr, nullptr, nullptr) == SQLITE_OK, sql);
  };
  run("PRAGMA synchronous=OFF");
  if (!options.finished) run("PRAGMA journal_mode=WAL; PRAGMA wal_autocheckpoint=0;");
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
      " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
      " timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
      "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
      "BEGIN");
  sqlite3_stmt* topic = nullptr;
  sqlite3_stmt* row = nullptr;
  sqlite3_prepare_v2(database, "INSERT OR IGNORE INTO topics VALUES(?, ?, ?, 'cdr', '')", -1,
                     &topic, nullptr);
  sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                     -1, &row, nullptr);
  const auto ids = number_topics(messages);
  for (const TestMessage& message : messages) {
    const std::int64_t id = ids.at(message.topic) + 1;
    sqlite3_bind_int64(topic, 1, id);
    sqlite3_bind_text(topic, 2, message.topic.c_str(), -1, SQLITE_STATIC);
    sqlite3_bind_text(topic, 3, ros2_type(message.kind).c_str(), -1, SQLITE_TRANSIENT);
    require(sqlite3_step(topic) == SQLITE_DONE && sqlite3_reset(topic) == SQLITE_OK, "topic");
    const Buffer data = cdr_serialised(message, options);
    sqlite3_bind_int64(row, 1, id);
    sqlite3_bind_int64(row, 2, message.time_ns);
    sqlite3_bind_blob(row, 3, data.data(), static_cast<int>(data.size()), SQLITE_STATIC);
    require(sqlite3_step(row) == SQLITE_DONE && sqlite3_reset(row) == SQLITE_OK, "message");
  }
  run("COMMIT");
  sqlite3_finalize(topic);
  sqlite3_finalize(row);
  // One that dies leaves its log behind; closing would fold it in.
  const auto log = std::filesystem::path(file.string() + "-wal");
  const Buffer kept = options.finished ? Buffer() : load_file(log);
  const Buffer unfolded = options.finished ? Buffer() : load_file(file);
  require(sqlite3_close(database) == SQLITE_OK, "close");
  if (options.finished) return;
  save(file, unfolded);
  save(log, kept);
}

void save(const std::filesystem::path& file, const Buffer& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

Buffer load_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return to_bytes(std::string(std::istreambuf_iterator<char>(stream), {}));
}

std::vector<TestMessage> read_messages(const std::filesystem::path& path, std::string* problem) {
  const std::unique_ptr<MessageReader> reader = open_messages(path);
  MessageDecoder decoder;
  std::vector<TestMessage> messages;
  Message message;
  while (reader->next(message)) {
    TestMessage read{Kind::kOther, std::string(message.topic), message.host_time.ns, {}};
    if (is_packet_type(message.type)) {
      const ByteSpan packet = decoder.packet(message).value_or(ByteSpan());
      read.kind = Kind::kPacket;
      read.body.assign(packet.begin(), packet.end());
    } else if (is_text_type(message.type)) {
      read.kind = Kind::kText;
      read.body = to_bytes(decoder.text(message).value_or("malformed"));
    }
    messages.push_back(std::move(read));
  }
  if (problem != nullptr) *problem = reader->problem();
  return messages;
}

}  // namespace glint::recording::test
