// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "daemon/record/capture_parts.hpp"

namespace glint::daemon {

struct RecordingOptions {
  std::string sensor;                       ///< HOST or HOST:PORT of its HTTP interface.
  std::string metadata_json;                ///< Empty: the sensor is asked.
  bool configure = false;                   ///< Have it send here; else it is left as it is.
  std::optional<std::uint16_t> lidar_port;  ///< Null: as the sensor has it.
  std::optional<std::uint16_t> imu_port;
  int rcvbuf_bytes = 8 << 20;
  CapturePartsOptions files;
  std::optional<double> seconds;  ///< Of recording; null: until a signal comes.
  double patience_s = 30.0;       ///< For the sensor's metadata.
  /// Told what happens, a sentence each.
  std::function<void(const std::string&)> on_news;
};

/// What was recorded. Value type.
struct RecordingResult {
  std::uint64_t lidar_packets = 0;
  std::uint64_t imu_packets = 0;
  std::uint64_t other_packets = 0;  ///< Of neither size; recorded too.
  std::uint64_t kernel_drops = 0;   ///< The receive buffer was full.
  std::uint64_t disk_drops = 0;     ///< The disk was too slow for too long.
  std::uint64_t bytes = 0;
  std::uint64_t files = 0;
  std::uint64_t deleted_files = 0;
  double seconds = 0.0;
  int granted_rcvbuf_bytes = 0;
};

/// Records a sensor's packets until time is up, or SIGINT or SIGTERM comes. Packets have the
/// kernel's times of arrival. What is received is in the kernel's hands within a quarter of a
/// second, so that it survives SIGKILL, and on the disk within about one, so that it survives a
/// loss of power; a slow disk does not keep packets from being received.
/// @throws InputError, or std::runtime_error with what failed: what was recorded stays.
RecordingResult record(const RecordingOptions& options);

}  // namespace glint::daemon
