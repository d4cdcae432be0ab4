// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/osf_file.hpp"

#include <vector>

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

}  // namespace

bool is_osf(ByteSpan start) { return FlatTable::root(start, "OSF$").has_value(); }

std::optional<std::string> find_osf_metadata(const std::filesystem::path& path) {
  std::vector<std::byte> bytes;
  InputFile(path).read(kHeaderBytes, bytes);
  const std::optional<FlatTable> header = FlatTable::root(bytes, "OSF$");
  const auto offset = header ? header->u64(kHeaderMetadataOffset) : std::nullopt;

  InputFile file(path);
  if (!offset || !file.skip(*offset)) return std::nullopt;
  file.read(kMaxMetadataBytes, bytes);
  const std::optional<FlatTable> metadata = FlatTable::root(bytes, "OSF#");
  for (std::uint32_t i = 0; metadata && i < kMaxEntries; ++i) {
    const std::optional<FlatTable> entry = metadata->table(kMetadataEntries, i);
    if (!entry) break;
    if (as_text(entry->bytes(kEntryType)) != kSensorType) continue;
    const auto sensor = FlatTable::root(entry->bytes(kEntryBuffer), "oLS_");
    if (sensor) return std::string(as_text(sensor->bytes(kSensorMetadata)));
  }
  return std::nullopt;
}

}  // namespace glint::recording
