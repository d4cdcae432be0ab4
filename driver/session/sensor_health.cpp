// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/sensor_health.hpp"

#include <algorithm>
#include <string_view>

#include "driver/session/sensor_json.hpp"

namespace glint {
namespace {

using nlohmann::json;

/// More are not of use to anyone, and a sensor could send any number.
constexpr std::size_t kMaxAlerts = 64;

std::string word(const json& object, const char* key) {
  return excerpt(text_member(object, key), 200);
}

bool speaks_of(const SensorAlert& alert, std::string_view what) {
  return alert.category.find(what) != std::string::npos;
}

std::optional<bool> locked_member(const json& object) {
  const auto locked = integer_member(object, "locked");
  if (locked) return *locked != 0;
  const json& flag = member(object, "locked");
  return flag.is_boolean() ? std::optional(flag.get<bool>()) : std::nullopt;
}

}  // namespace

std::vector<SensorAlert> parse_alerts(const json& value) {
  std::vector<SensorAlert> alerts;
  for (const json& entry : member(value, "active")) {
    if (!entry.is_object() || alerts.size() == kMaxAlerts) continue;
    alerts.push_back(
        {word(entry, "id"), word(entry, "category"), word(entry, "level"), word(entry, "msg")});
  }
  return alerts;
}

SensorTelemetry parse_telemetry(const json& value) {
  return {number_member(value, "input_voltage_mv"), number_member(value, "input_current_ma"),
          number_member(value, "internal_temperature_deg_c"), word(value, "phase_lock_status")};
}

PtpState parse_ptp(const json& value) {
  const json& port = member(value, "port_data_set");
  const json& properties = member(value, "time_properties_data_set");
  PtpState state;
  state.port_state = word(port, "port_state");
  state.grandmaster = word(member(value, "parent_data_set"), "grandmaster_identity");
  state.offset_ns = number_member(member(value, "current_data_set"), "offset_from_master");
  if (const auto offset = integer_member(properties, "current_utc_offset");
      offset && std::abs(*offset) < 1000) {
    state.utc_offset_s = static_cast<int>(*offset);
  }
  // A port is named by its clock's identity and a number: "bc0fa7.fffe.c48254-1".
  const std::string own = word(port, "port_identity");
  const bool is_own = state.grandmaster == own.substr(0, own.rfind('-'));
  state.locked = state.port_state == "SLAVE" && !state.grandmaster.empty() && !is_own;
  return state;
}

SensorTimeState parse_time(const json& value) {
  // The text commands of old firmware put everything one level down.
  const json& inner = member(value, "sensor");
  const json& root = inner.is_object() ? inner : value;
  const json& timestamp = member(root, "timestamp");
  return {word(timestamp, "mode"), number_member(timestamp, "time"),
          locked_member(member(root, "sync_pulse_in"))};
}

void take_alerts(SensorHealth& health, std::vector<SensorAlert> alerts) {
  health.alerts = std::move(alerts);
  health.overheating = std::ranges::any_of(health.alerts, [](const SensorAlert& alert) {
    return speaks_of(alert, "OVERTEMP") || speaks_of(alert, "THERMAL");
  });
  health.shot_limiting = std::ranges::any_of(
      health.alerts, [](const SensorAlert& alert) { return speaks_of(alert, "SHOT_LIMITING"); });
}

}  // namespace glint
