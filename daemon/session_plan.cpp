// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/session_plan.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "daemon/input.hpp"
#include "daemon/saved_maps.hpp"
#include "daemon/session_files.hpp"
#include "driver/core/error.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;

bool has_keyframes(const fs::path& file) {
  try {
    return slam::SessionReader(file).keyframe_count() > 0;
  } catch (const InputError& error) {
    spdlog::warn("map.on_start: {}", error.what());
    return false;
  }
}

// The saved map of that name.
fs::path map_to_localize_in(const Config& config, std::string_view name) {
  const SavedMaps maps(state_directory(config));
  if (!maps.has_place()) {
    throw ConfigError(fmt::format("map.on_start = \"{}{}\" needs state.directory, where maps are",
                                  kLocalizePrefix, name));
  }
  if (!maps.contains(name)) {
    throw ConfigError(fmt::format("map.on_start: there is no map '{}': {} is missing", name,
                                  maps.file_of(name).string()));
  }
  return maps.file_of(name);
}

}  // namespace

SessionPlan plan_session_anew(const Config& config) {
  SessionPlan plan;
  plan.file = new_session_file(config);
  plan.search_s = config.map.search_s;
  return plan;
}

SessionPlan plan_extension(const Config& config, const fs::path& earlier) {
  SessionPlan plan = plan_session_anew(config);
  plan.otherwise = plan.file;  // It is not written to before the sensor is found.
  plan.earlier = earlier;
  return plan;
}

SessionPlan plan_localization(const Config& config, const fs::path& map) {
  SessionPlan plan;
  plan.earlier = map;
  plan.search_s = config.map.search_s;
  plan.use = slam::MapUse::kLocalize;
  return plan;
}

SessionPlan plan_session(const Config& config) {
  if (config.map.on_start.starts_with(kLocalizePrefix)) {
    const std::string_view name =
        std::string_view{config.map.on_start}.substr(kLocalizePrefix.size());
    const fs::path map = map_to_localize_in(config, name);
    spdlog::info("the sensor is looked for in the map {}, which is only read", map.string());
    return plan_localization(config, map);
  }
  SessionPlan plan = plan_session_anew(config);
  if (config.map.on_start != "continue" || plan.file.empty()) return plan;
  const std::vector<fs::path> sessions = own_sessions(plan.file.parent_path());
  const auto latest = std::find_if(sessions.rbegin(), sessions.rend(), has_keyframes);
  if (latest == sessions.rend()) {
    spdlog::info("map.on_start: there is no session to go on with; an empty map is begun");
    return plan;
  }
  plan.otherwise = plan.file;
  plan.file = plan.earlier = *latest;
  spdlog::info("going on with the map of {}", plan.earlier.string());
  return plan;
}

}  // namespace glint::daemon
