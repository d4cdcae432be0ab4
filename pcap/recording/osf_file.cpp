// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/osf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "pcap/recording/crc32.hpp"
#include "pcap/recording/flat_table.hpp"
#include "pcap/recording/input_file.hpp"

namespace glint::recording {
namespace {

// Fields by their order in the public schemas.
constexpr int kHeaderMetadataOffset = 2;
constexpr int kMetadataEntries = 4;
constexpr int kEntryType = 1;
constexpr int kEntryBuffer = 2;
constexpr int kSensorMetadata = 0;

constexpr std::string_view kSensorType = "ouster/v1/os_sensor/LidarSensor";
/// A header is some 50 bytes.
constexpr std::uint64_t kHeaderBytes = 256;
/// Of a day's recording, with a reference to each of its chunks.
constexpr std::uint64_t kMaxMetadataBytes = std::uint64_t{64} << 20U;
constexpr std::uint32_t kMaxEntries = 4096;

/// Whether a block, its size in front, ends in the CRC-32 of all before it.
bool is_sound(ByteSpan block) {
  ByteReader reader(block);
  static_cast<void>(reader.bytes(reader.integer<std::uint32_t>()));
  const ByteSpan content = block.first(block.size() - reader.left());
  const auto checksum = reader.integer<std::uint32_t>();
  return reader.ok() && checksum == crc32(content);
}

/// The last part of a type; empty if it is nothing to be shown to a user.
std::string_view kind_of(std::string_view type) {
  constexpr std::size_t kMaxLetters = 64;
  const std::string_view kind = type.substr(type.rfind('/') + 1);
  const auto is_usual = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return kind.size() <= kMaxLetters && std::ranges::all_of(kind, is_usual) ? kind
                                                                           : std::string_view();
}

/// "2 LidarScanStream, 2 LidarSensor, 1 StreamingInfo, ...".
std::string list_kinds(const std::vector<std::string>& kinds) {
  constexpr std::size_t kListed = 8;
  std::map<std::string_view, int> counts;
  for (const std::string& kind : kinds) ++counts[kind];
  std::string list;
  std::size_t listed = 0;
  for (const auto& [kind, count] : counts) {
    if (listed++ == kListed) return list + ", ...";
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, kind);
  }
  return list.empty() ? "nothing" : list;
}

}  // namespace

bool is_osf(ByteSpan start) { return FlatTable::root(start, "OSF$").has_value(); }

std::optional<OsfContents> parse_osf_metadata(ByteSpan block) {
  const std::optional<FlatTable> metadata = FlatTable::root(block, "OSF#");
  if (!metadata) return std::nullopt;
  OsfContents contents;
  for (std::uint32_t i = 0; i < kMaxEntries; ++i) {
    const std::optional<FlatTable> entry = metadata->table(kMetadataEntries, i);
    if (!entry) break;
    const std::string_view type = as_text(entry->bytes(kEntryType));
    const std::string_view kind = kind_of(type);
    if (!kind.empty()) contents.kinds.emplace_back(kind);
    if (contents.sensor || type != kSensorType) continue;
    const auto sensor = FlatTable::root(entry->bytes(kEntryBuffer), "oLS_");
    if (sensor) contents.sensor = as_text(sensor->bytes(kSensorMetadata));
  }
  return contents;
}

std::optional<OsfContents> read_osf(const std::filesystem::path& path) {
  std::vector<std::byte> bytes;
  InputFile(path).read(kHeaderBytes, bytes);
  const std::optional<FlatTable> header = FlatTable::root(bytes, "OSF$");
  const auto offset = header ? header->u64(kHeaderMetadataOffset) : std::nullopt;

  InputFile file(path);
  if (!offset || !file.skip(*offset)) return std::nullopt;
  file.read(kMaxMetadataBytes, bytes);
  return is_sound(bytes) ? parse_osf_metadata(bytes) : std::nullopt;
}

std::string osf_refusal(const std::filesystem::path& file, const std::filesystem::path& name) {
  const std::optional<OsfContents> contents = read_osf(file);
  return fmt::format(
      "{} is an OSF file, which holds scans that were decoded already and no packets ({}); give "
      "the pcap or bag that it was made from, or make a capture of its scans, without legacy IMU "
      "packets, with Ouster's SDK: ouster-cli source FILE.osf save FILE.pcap.",
      name.string(),
      contents ? "its metadata lists: " + list_kinds(contents->kinds)
               : "it was never finished or is damaged: the metadata at its end is missing");
}

}  // namespace glint::recording
