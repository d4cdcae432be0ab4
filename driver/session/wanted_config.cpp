// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/wanted_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "driver/core/error.hpp"

namespace glint {
namespace {

constexpr int kFullTurn_mdeg = 360'000;
/// A window end below one degree: a user who meant degrees.
constexpr int kSuspiciousEnd_mdeg = 1000;

void require_range(const char* key, std::optional<int> value, int least, int largest) {
  if (!value || (*value >= least && *value <= largest)) return;
  throw InputError(fmt::format("sensor setting {} = {} is out of range; write {} to {}", key,
                               *value, least, largest));
}

void require_choice(const char* key, const std::optional<std::string>& value,
                    std::initializer_list<std::string_view> choices) {
  if (!value || std::ranges::find(choices, *value) != choices.end()) return;
  throw InputError(
      fmt::format("sensor setting {} = '{}' is none of {}", key, *value, fmt::join(choices, ", ")));
}

/// Commands and lines are built of these: no blanks, no control characters.
void require_word(const char* key, const std::optional<std::string>& value) {
  const auto is_graphic = [](char c) { return c > ' ' && c <= '~'; };
  if (!value || std::ranges::all_of(*value, is_graphic)) return;
  throw InputError(
      fmt::format("sensor setting {} holds a blank or a special character; write one word", key));
}

void require_window(const std::array<int, 2>& window) {
  const auto [start, end] = window;
  require_range("azimuth_window", start, 0, kFullTurn_mdeg);
  require_range("azimuth_window", end, 0, kFullTurn_mdeg);
  if (end > 0 && end < kSuspiciousEnd_mdeg && start < end) {
    throw InputError(
        fmt::format("sensor setting azimuth_window = [{}, {}] is narrower than a degree; its unit "
                    "is a thousandth of a degree, write e.g. [0, 360000] for a full turn",
                    start, end));
  }
  if (start == end) {
    throw InputError(fmt::format(
        "sensor setting azimuth_window = [{0}, {0}] is empty; write [0, 360000] for a full turn",
        start));
  }
}

}  // namespace

void check(const WantedConfig& wanted) {
  constexpr int kLastPort = 65535;
  require_range("udp_port_lidar", wanted.udp_port_lidar, 0, kLastPort);
  require_range("udp_port_imu", wanted.udp_port_imu, 0, kLastPort);
  require_range("phase_lock_offset", wanted.phase_lock_offset_mdeg, 0, kFullTurn_mdeg);
  require_range("min_range_threshold_cm", wanted.min_range_threshold_cm, 0, 1000);
  require_range("columns_per_packet", wanted.columns_per_packet, 1, 64);
  require_range("udp_multicast_ttl", wanted.udp_multicast_ttl, 0, 255);
  require_choice("operating_mode", wanted.operating_mode, {"NORMAL", "STANDBY"});
  require_choice("timestamp_mode", wanted.timestamp_mode,
                 {"TIME_FROM_INTERNAL_OSC", "TIME_FROM_SYNC_PULSE_IN", "TIME_FROM_PTP_1588"});
  // New firmware brings new modes and profiles; which it takes, the sensor says.
  require_word("udp_dest", wanted.udp_dest);
  require_word("lidar_mode", wanted.lidar_mode);
  require_word("udp_profile_lidar", wanted.udp_profile_lidar);
  require_word("udp_profile_imu", wanted.udp_profile_imu);
  require_word("return_order", wanted.return_order);
  if (wanted.azimuth_window_mdeg) require_window(*wanted.azimuth_window_mdeg);
}

nlohmann::json to_sensor_json(const WantedConfig& wanted, FirmwareVersion firmware) {
  nlohmann::json out = nlohmann::json::object();
  const auto put = [&out](const char* key, const auto& value) {
    if (value) out[key] = *value;
  };
  put("udp_dest", wanted.udp_dest);
  put("udp_port_lidar", wanted.udp_port_lidar);
  put("udp_port_imu", wanted.udp_port_imu);
  put("lidar_mode", wanted.lidar_mode);
  put("timestamp_mode", wanted.timestamp_mode);
  put("operating_mode", wanted.operating_mode);
  put("udp_profile_lidar", wanted.udp_profile_lidar);
  put("udp_profile_imu", wanted.udp_profile_imu);
  put("return_order", wanted.return_order);
  put("phase_lock_enable", wanted.phase_lock_enable);
  put("phase_lock_offset", wanted.phase_lock_offset_mdeg);
  put("signal_multiplier", wanted.signal_multiplier);
  put("columns_per_packet", wanted.columns_per_packet);
  put("min_range_threshold_cm", wanted.min_range_threshold_cm);
  put("udp_multicast_ttl", wanted.udp_multicast_ttl);
  if (wanted.azimuth_window_mdeg) {
    // Firmware 1 counts hundredths of a degree.
    const int unit = firmware.major_number < 2 ? 10 : 1;
    const auto [start, end] = *wanted.azimuth_window_mdeg;
    out["azimuth_window"] = {start / unit, end / unit};
  }
  // 1 and 2 were whole numbers before 0.25 and 0.5 came.
  if (wanted.signal_multiplier && *wanted.signal_multiplier >= 1.0) {
    out["signal_multiplier"] = static_cast<int>(*wanted.signal_multiplier);
  }
  return out;
}

}  // namespace glint
