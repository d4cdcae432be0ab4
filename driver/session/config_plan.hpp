// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace glint {

/// What must change at a sensor for it to be as wanted. Value type.
struct ConfigPlan {
  nlohmann::json changes = nlohmann::json::object();  ///< Under the names that this sensor uses.
  std::vector<std::string> lines;  ///< For people: "lidar_mode: 512x10 -> 1024x10".
};

/// Compares the wanted settings with those in force. "@auto" as udp_dest is met by `local_address`.
/// Sensors that know a setting by its older name (udp_ip, auto_start_flag) get that name.
ConfigPlan plan_changes(const nlohmann::json& wanted, const nlohmann::json& active,
                        const std::string& local_address);

}  // namespace glint
