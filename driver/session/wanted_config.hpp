// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "driver/session/firmware_version.hpp"

namespace glint {

/// Settings that the user wants of the sensor; what is not set is left as the sensor has it.
/// Spellings are the sensor's own. Value type.
struct WantedConfig {
  std::optional<std::string> udp_dest;  ///< Address, or "@auto": this machine.
  std::optional<int> udp_port_lidar;
  std::optional<int> udp_port_imu;
  std::optional<std::string> lidar_mode;      ///< "1024x10", "2048x10", ...
  std::optional<std::string> timestamp_mode;  ///< "TIME_FROM_PTP_1588", ...
  std::optional<std::string> operating_mode;  ///< "NORMAL" or "STANDBY".
  std::optional<std::string> udp_profile_lidar;
  std::optional<std::string> udp_profile_imu;
  std::optional<std::string> return_order;
  std::optional<std::array<int, 2>> azimuth_window_mdeg;  ///< Start and end; may wrap.
  std::optional<bool> phase_lock_enable;
  std::optional<int> phase_lock_offset_mdeg;
  std::optional<double> signal_multiplier;
  std::optional<int> columns_per_packet;
  std::optional<int> min_range_threshold_cm;
  std::optional<int> udp_multicast_ttl;
};

/// Refuses what no sensor takes. @throws InputError that names the setting and the range.
void check(const WantedConfig& wanted);

/// The settings as a sensor of this firmware writes them: an object of keys and values.
nlohmann::json to_sensor_json(const WantedConfig& wanted, FirmwareVersion firmware);

}  // namespace glint
