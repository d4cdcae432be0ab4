// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <string_view>

namespace glint::recording {

/// Kinds of recordings other than captures.
enum class RecordingFormat {
  kNone,    ///< None of those below.
  kRos1,    ///< ROS 1 bag.
  kSqlite,  ///< ROS 2 bag stored in SQLite, or any other SQLite database.
  kMcap,    ///< MCAP file, a ROS 2 bag or not.
  kOsf,     ///< Open Sensor Format: decoded scans and metadata, but no packets.
  kZstd,    ///< Any of these, packed whole with zstd.
};

/// "ROS 1 bag", "MCAP", ...
std::string_view to_string(RecordingFormat format);

/// Tells a file's format by its first bytes; kNone also for what is no readable file.
RecordingFormat recording_format(const std::filesystem::path& file);

}  // namespace glint::recording
