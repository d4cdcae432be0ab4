// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "driver/session/session_status.hpp"

namespace glint {

/// Why no packets come of a sensor that answers: one sentence with the likeliest reason and the way
/// out, by its status, its alerts, where it sends them, and this machine's address.
std::string why_no_packets(const SessionStatus& status, const nlohmann::json& active_config,
                           const std::string& local_address);

}  // namespace glint
