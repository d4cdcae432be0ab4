// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/protocol.hpp"
#include "daemon/runtime.hpp"

namespace glint::daemon {

/// What get_status tells beside the runtime's own status.
struct ServiceStatus {
  std::string instance;
  std::string source_name;
  std::string session_file;
  std::int64_t uptime_ns = 0;
  std::int64_t scan_period_ns = 0;
  std::size_t clients = 0;
};

/// WAITING_DATA RUNNING STALLED ENDED FAILED.
std::string_view to_string(SourceState state);

/// get_status and the status notification. `now_ns`: steady clock.
Json status_json(const RuntimeStatus& runtime, const ServiceStatus& service, std::int64_t now_ns);

}  // namespace glint::daemon
