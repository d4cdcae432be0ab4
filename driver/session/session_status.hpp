// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "driver/session/sensor_health.hpp"

namespace glint {

/// What a session with a sensor is at.
enum class SessionState {
  kDiscovering,  ///< Looks for the sensor, which may have no power yet.
  kConfiguring,  ///< Reads the settings, writes those that differ, reads the metadata.
  kWaitingData,  ///< Expects the first packet.
  kRunning,
  kStalled,  ///< Packets have stopped.
};

/// "DISCOVERING", "CONFIGURING", "WAITING_DATA", "RUNNING", "STALLED".
std::string_view to_string(SessionState state);

/// Everything there is to tell of a session at one moment. Value type.
struct SessionStatus {
  SessionState state = SessionState::kDiscovering;
  std::int64_t state_since_ns = 0;
  std::string host;
  /// Of the last attempt: the step, the host, what went wrong and the way out. Empty when the step
  /// has since been passed.
  std::string failure;
  std::uint64_t failures = 0;
  std::int64_t next_attempt_ns = 0;  ///< While the last attempt has failed.

  // What the sensor says of itself; empty or 0 while unknown.
  std::string product_line;
  std::string serial_number;
  std::string firmware;
  std::string sensor_status;  ///< "RUNNING", "STANDBY", "ERROR", ...
  std::string address;        ///< IP address that the host has been reached at.
  std::string udp_dest;       ///< Where it sends its packets.
  std::uint32_t init_id = 0;

  std::uint64_t restarts = 0;             ///< Of the sensor, seen in this session.
  std::uint64_t config_writes = 0;        ///< Each makes it reinitialise.
  std::vector<std::string> last_changes;  ///< Of the last write: "lidar_mode: 512x10 -> 1024x10".
  std::vector<std::string> unmet;         ///< Settings that it took and yet does not report.
  SensorHealth health;
};

}  // namespace glint
