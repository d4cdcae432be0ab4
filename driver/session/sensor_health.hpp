// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace glint {

/// Something that the sensor complains of. Value type.
struct SensorAlert {
  std::string id;        ///< "0x01000015".
  std::string category;  ///< "UDP_TRANSMISSION", "OVERTEMP", ...
  std::string level;     ///< "WARNING", "ERROR", ...
  std::string message;
};

/// Alert ids with a meaning for the session.
constexpr const char* kLidarUnreachableAlert = "0x01000015";
constexpr const char* kImuUnreachableAlert = "0x01000018";

struct SensorTelemetry {
  std::optional<double> input_voltage_mv;
  std::optional<double> input_current_ma;
  std::optional<double> temperature_degc;  ///< Inside the sensor.
  std::string phase_lock;                  ///< "LOCKED", "DISABLED", ...
};

struct PtpState {
  std::string port_state;           ///< "SLAVE" once it follows a clock.
  std::string grandmaster;          ///< Identity of that clock.
  std::optional<double> offset_ns;  ///< From it.
  std::optional<int> utc_offset_s;  ///< TAI - UTC as the clock announces it.
  bool locked = false;              ///< It follows a clock that is not its own.
};

struct SensorTimeState {
  std::string mode;  ///< "TIME_FROM_INTERNAL_OSC", ...
  std::optional<double> time_s;
  std::optional<bool> sync_pulse_locked;
};

/// How a sensor is doing, as far as its firmware says. Value type.
struct SensorHealth {
  std::vector<SensorAlert> alerts;  ///< Those active now.
  bool overheating = false;         ///< By the active alerts.
  bool shot_limiting = false;       ///< It lowers its laser power, so ranges shrink.
  std::optional<SensorTelemetry> telemetry;
  std::optional<PtpState> ptp;
  std::optional<SensorTimeState> time;
  std::string failure;  ///< Why the last look at it failed; empty when it did not.
};

// What sensors answer, of which nothing is trusted: what is missing or odd stays empty.
std::vector<SensorAlert> parse_alerts(const nlohmann::json& value);
SensorTelemetry parse_telemetry(const nlohmann::json& value);
PtpState parse_ptp(const nlohmann::json& value);
SensorTimeState parse_time(const nlohmann::json& value);

/// Puts the alerts into the health, with what follows from them.
void take_alerts(SensorHealth& health, std::vector<SensorAlert> alerts);

}  // namespace glint
