// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/session_plan.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <vector>

#include "daemon/input.hpp"
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

SessionPlan plan_session(const Config& config) {
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
