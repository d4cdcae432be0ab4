// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/crc32.hpp"
#include "pcap/recording/test_recording.hpp"

namespace glint::recording::test {
namespace {

/// One table of a FlatBuffers buffer whose fields are offsets to what follows it.
struct Offset {
  int field = 0;
  Buffer target;  ///< A string or vector, its length in front; see vector().
};

Buffer vector(const Buffer& bytes) {
  ByteWriter out;
  out.integer(static_cast<std::uint32_t>(bytes.size())).bytes(bytes);
  while (out.buffer().size() % 4 != 0) out.integer(std::uint8_t{0});
  return out.buffer();
}

/// A table, its list of fields in front, and what its fields refer to behind. `table_at` is set to
/// where in the bytes the table itself is.
Buffer table(int fields, const std::vector<Offset>& offsets, std::size_t& table_at) {
  const std::size_t list_bytes = 4 + 4 * ((static_cast<std::size_t>(fields) + 1) / 2);
  std::vector<std::uint16_t> places(2 * ((static_cast<std::size_t>(fields) + 1) / 2));
  std::uint16_t place = 4;
  for (const Offset& offset : offsets) {
    places[static_cast<std::size_t>(offset.field)] = place;
    place = static_cast<std::uint16_t>(place + 4);
  }
  ByteWriter out;
  out.integer(static_cast<std::uint16_t>(list_bytes)).integer(place);
  for (const std::uint16_t p : places) out.integer(p);
  table_at = out.buffer().size();
  out.integer(static_cast<std::uint32_t>(table_at));
  std::size_t behind = 4 * offsets.size();
  for (const Offset& offset : offsets) {
    out.integer(static_cast<std::uint32_t>(behind));
    behind += offset.target.size() - 4;
  }
  for (const Offset& offset : offsets) out.bytes(offset.target);
  return out.buffer();
}

/// A buffer with its size in front: place of the root, identifier, and the tables.
Buffer sized(std::string_view identifier, const Buffer& tables, std::size_t root_at) {
  return ByteWriter()
      .integer(static_cast<std::uint32_t>(tables.size() + 8))
      .integer(static_cast<std::uint32_t>(root_at + 8))
      .text(identifier)
      .bytes(tables)
      .buffer();
}

Buffer header(std::uint64_t metadata_at) {
  ByteWriter out;
  // Fields: version, status, metadata_offset, file_length.
  for (const int place : {12, 28, 0, 0, 4, 12}) out.integer(static_cast<std::uint16_t>(place));
  out.integer(std::uint32_t{12});
  out.integer(metadata_at).integer(std::uint64_t{0}).integer(std::uint64_t{0});
  return sized("OSF$", out.buffer(), 12);
}

}  // namespace

Buffer osf_metadata(const std::vector<std::string>& sensors) {
  std::size_t at = 0;
  const auto entry = [&](std::string_view type, const Buffer& buffer) {
    return table(3, {{1, vector(to_bytes(type))}, {2, vector(buffer)}}, at);
  };
  std::vector<Buffer> entries{entry("ouster/v1/streaming/StreamingInfo", Buffer(8))};
  for (const std::string& metadata : sensors) {
    const Buffer sensor = table(1, {{0, vector(to_bytes(metadata))}}, at);
    entries.push_back(entry("ouster/v1/os_sensor/LidarSensor", sized("oLS_", sensor, at)));
    entries.push_back(entry("ouster/v1/os_sensor/LidarScanStream", Buffer(8)));
  }
  // The number of entries, where each is from the place that says so, and they.
  ByteWriter list;
  list.integer(static_cast<std::uint32_t>(entries.size()));
  std::size_t behind = 4 * entries.size();
  for (const Buffer& bytes : entries) {
    list.integer(static_cast<std::uint32_t>(behind + at));
    behind += bytes.size() - 4;
  }
  for (const Buffer& bytes : entries) list.bytes(bytes);
  const Buffer root = table(5, {{4, list.buffer()}}, at);
  return sized("OSF#", root, at);
}

Buffer osf(const std::vector<std::string>& sensors, bool finished) {
  const auto with_checksum = [](const Buffer& block) {
    return ByteWriter().bytes(block).integer(crc32(block)).buffer();
  };
  const std::uint64_t metadata_at = with_checksum(header(0)).size();
  if (!finished) return with_checksum(header(0));
  return ByteWriter()
      .bytes(with_checksum(header(metadata_at)))
      .bytes(with_checksum(osf_metadata(sensors)))
      .buffer();
}

}  // namespace glint::recording::test
