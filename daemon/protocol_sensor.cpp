// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// What get_status says of the sensor: by its packets, and by the session with it.
#include <algorithm>
#include <cmath>

#include "daemon/protocol_status.hpp"

namespace glint::daemon {
namespace {

/// Absent means unknown.
template <class T>
void put_known(Json& out, const char* key, const std::optional<T>& value) {
  if (!value) return;
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(*value)) return;
  }
  out[key] = *value;
}

void put_known(Json& out, const char* key, const std::string& value) {
  if (!value.empty()) out[key] = value;
}

Json alert_json(const SensorAlert& alert) {
  return Json{{"id", alert.id},
              {"category", alert.category},
              {"level", alert.level},
              {"message", alert.message}};
}

Json telemetry_json(const SensorTelemetry& telemetry) {
  Json out = Json::object();
  put_known(out, "input_voltage_mv", telemetry.input_voltage_mv);
  put_known(out, "input_current_ma", telemetry.input_current_ma);
  put_known(out, "temperature_degc", telemetry.temperature_degc);
  put_known(out, "phase_lock", telemetry.phase_lock);
  return out;
}

Json ptp_json(const PtpState& ptp) {
  Json out{{"locked", ptp.locked}};
  put_known(out, "port_state", ptp.port_state);
  put_known(out, "grandmaster", ptp.grandmaster);
  put_known(out, "offset_ns", ptp.offset_ns);
  put_known(out, "utc_offset_s", ptp.utc_offset_s);
  return out;
}

Json time_json(const SensorTimeState& time) {
  Json out = Json::object();
  put_known(out, "timestamp_mode", time.mode);
  put_known(out, "time_s", time.time_s);
  put_known(out, "sync_pulse_locked", time.sync_pulse_locked);
  return out;
}

Json health_json(const SensorHealth& health) {
  Json alerts = Json::array();
  for (const SensorAlert& alert : health.alerts) alerts.push_back(alert_json(alert));
  Json out{{"alerts", std::move(alerts)},
           {"overheating", health.overheating},
           {"shot_limiting", health.shot_limiting}};
  if (health.telemetry) out["telemetry"] = telemetry_json(*health.telemetry);
  if (health.ptp) out["ptp"] = ptp_json(*health.ptp);
  if (health.time) out["time"] = time_json(*health.time);
  put_known(out, "failure", health.failure);
  return out;
}

}  // namespace

Json packet_health_json(const PacketHealth& health) {
  constexpr std::uint8_t kAnyAlert = 0x80;
  return Json{{"alert", (health.alert_flags & kAnyAlert) != 0},
              {"alert_flags", health.alert_flags},
              {"thermal_state", health.thermal_state},
              {"thermal_countdown_s", health.thermal_countdown_s},
              {"shot_limiting_state", health.shot_limiting_state},
              {"shot_limiting_countdown_s", health.shot_limiting_countdown_s}};
}

Json session_json(const SessionStatus& session, std::int64_t now_ns) {
  const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) * kSecondsPerNs; };
  Json out{{"host", session.host},
           {"state", to_string(session.state)},
           {"state_age_s", seconds(std::max<std::int64_t>(0, now_ns - session.state_since_ns))},
           {"failures", session.failures}};
  put_known(out, "failure", session.failure);
  if (session.next_attempt_ns > now_ns) {
    out["next_attempt_s"] = seconds(session.next_attempt_ns - now_ns);
  }
  put_known(out, "address", session.address);
  put_known(out, "product_line", session.product_line);
  put_known(out, "serial_number", session.serial_number);
  put_known(out, "firmware", session.firmware);
  put_known(out, "sensor_status", session.sensor_status);
  put_known(out, "udp_dest", session.udp_dest);
  if (session.init_id != 0) out["init_id"] = session.init_id;
  out["restarts"] = session.restarts;
  out["config_writes"] = session.config_writes;
  out["last_changes"] = session.last_changes;
  out["unmet"] = session.unmet;
  out["health"] = health_json(session.health);
  return out;
}

}  // namespace glint::daemon
