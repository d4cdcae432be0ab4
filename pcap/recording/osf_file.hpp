// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pcap/recording/byte_reader.hpp"

namespace glint::recording {

/// What the metadata at the end of an OSF file says.
struct OsfContents {
  /// What kind each entry is of, by the last part of its type: "LidarSensor", "LidarScanStream".
  /// Kinds of unusual letters are left out.
  std::vector<std::string> kinds;
  std::optional<std::string> sensor;  ///< The first sensor's metadata, as JSON.
};

/// Whether a file's first bytes are those of an OSF file ("Open Sensor Format").
bool is_osf(ByteSpan start);

/// Reads an OSF file's block of metadata, its size in front; null if it is none. Of the first 4096
/// entries. Does not look at the checksum. Thread-safe.
std::optional<OsfContents> parse_osf_metadata(ByteSpan block);

/// What an OSF file says of itself; null if it was never finished, since its metadata is written
/// last, or if the checksum says that the metadata is damaged. Thread-safe.
/// @throws InputError if the file cannot be read.
std::optional<OsfContents> read_osf(const std::filesystem::path& file);

/// Why an OSF file is no source of packets, what it holds in their place and the way out, as a
/// sentence. Of all streams that the public schemas know (Ouster SDK, ouster_osf/fb), none holds
/// packets: scans are decoded before they are stored. Thread-safe.
/// @param name The file as the user knows it.
/// @throws InputError if the file cannot be read.
std::string osf_refusal(const std::filesystem::path& file, const std::filesystem::path& name);

}  // namespace glint::recording
