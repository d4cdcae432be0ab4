// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/recording/recording_format.hpp"

#include <vector>

#include "driver/core/error.hpp"
#include "pcap/recording/inflater.hpp"
#include "pcap/recording/input_file.hpp"
#include "pcap/recording/mcap_reader.hpp"
#include "pcap/recording/osf_file.hpp"
#include "pcap/recording/ros1_bag_reader.hpp"
#include "pcap/recording/sqlite_bag_reader.hpp"

namespace glint::recording {

std::string_view to_string(RecordingFormat format) {
  switch (format) {
    case RecordingFormat::kRos1:
      return "ROS 1 bag";
    case RecordingFormat::kSqlite:
      return "ROS 2 bag (SQLite)";
    case RecordingFormat::kMcap:
      return "MCAP";
    case RecordingFormat::kOsf:
      return "OSF";
    case RecordingFormat::kZstd:
      return "packed with zstd";
    case RecordingFormat::kNone:
      break;
  }
  return "unknown";
}

RecordingFormat recording_format(const std::filesystem::path& file) {
  constexpr std::uint64_t kStartBytes = 256;
  std::vector<std::byte> start;
  try {
    InputFile(file).read(kStartBytes, start);
  } catch (const InputError&) {
    return RecordingFormat::kNone;
  }
  const std::string_view text = as_text(start);
  // All versions: the reader has the sentence for the old ones.
  if (text.starts_with("#ROSBAG V") || text.starts_with("#ROSRECORD V")) {
    return RecordingFormat::kRos1;
  }
  if (text.starts_with(kMcapMagic)) return RecordingFormat::kMcap;
  if (text.starts_with(kSqliteMagic)) return RecordingFormat::kSqlite;
  if (is_zstd(start)) return RecordingFormat::kZstd;
  return is_osf(start) ? RecordingFormat::kOsf : RecordingFormat::kNone;
}

}  // namespace glint::recording
