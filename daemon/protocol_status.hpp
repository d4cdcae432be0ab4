// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/protocol.hpp"
#include "daemon/runtime.hpp"
#include "daemon/server_counters.hpp"
#include "driver/session/session_status.hpp"

namespace glint::daemon {

/// What get_status tells beside the runtime's own status.
struct ServiceStatus {
  std::string instance;
  std::string source_name;
  std::int64_t uptime_ns = 0;
  std::int64_t scan_period_ns = 0;
  std::size_t clients = 0;
  const ServerCounters* server = nullptr;  ///< Null: there is none.
  std::size_t sessions_removed = 0;        ///< Old session files, at start.
  const SessionStatus* session = nullptr;  ///< Null: there is none with the sensor.
  std::string sensor_problem;  ///< A sentence on why the session does not help; may be empty.
};

/// WAITING_DATA RUNNING STALLED ENDED FAILED.
std::string_view to_string(SourceState state);

/// Why the sensor's packets are not taken: what they are and what metadata say. Empty when they
/// are, or none came.
std::string refusal_sentence(const RuntimeStatus& runtime);

/// State and alerts of the sensor as its packets have them.
Json packet_health_json(const PacketHealth& health);

/// The session's own part of get_status.
Json session_json(const SessionStatus& session, std::int64_t now_ns);

/// Every stage of the pipeline.
StageStats all_stages(const RuntimeStatus& runtime);

/// get_status and the status notification. `now_ns`: steady clock.
Json status_json(const RuntimeStatus& runtime, const ServiceStatus& service, std::int64_t now_ns);

}  // namespace glint::daemon
