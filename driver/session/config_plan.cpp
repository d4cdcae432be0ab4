// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/session/config_plan.hpp"

#include <fmt/format.h>

#include "driver/session/sensor_json.hpp"

namespace glint {
namespace {

using nlohmann::json;

struct Setting {
  std::string key;
  json value;
};

/// The setting in this sensor's own terms.
Setting in_terms_of(const json& active, const std::string& key, const json& value) {
  const bool known = active.contains(key);
  if (key == "udp_dest" && !known && active.contains("udp_ip")) return {"udp_ip", value};
  if (key == "operating_mode" && !known && active.contains("auto_start_flag")) {
    return {"auto_start_flag", value == "NORMAL" ? 1 : 0};
  }
  return {key, value};
}

bool is_met(const json& value, const json& active, const std::string& local_address) {
  // JSON's 1 and 1.0 are equal here.
  return value == active ||
         (value == "@auto" && !local_address.empty() && active == json(local_address));
}

std::string shown(const json& value) {
  return excerpt(value.is_string() ? value.get<std::string>() : value.dump(), 60);
}

}  // namespace

ConfigPlan plan_changes(const json& wanted, const json& active, const std::string& local_address) {
  ConfigPlan plan;
  for (const auto& [wanted_key, wanted_value] : wanted.items()) {
    const auto [key, value] = in_terms_of(active, wanted_key, wanted_value);
    const json& now = member(active, key.c_str());
    if (is_met(value, now, local_address)) continue;
    plan.changes[key] = value;
    plan.lines.push_back(
        fmt::format("{}: {} -> {}", key, now.is_null() ? "not set" : shown(now), shown(value)));
  }
  return plan;
}

}  // namespace glint
