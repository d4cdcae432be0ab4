// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/session_plan.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "daemon/input.hpp"
#include "driver/core/error.hpp"
#include "slam/store/session_reader.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;

// The latest first: a session is written to until its run ends.
std::vector<fs::path> sessions_in(const fs::path& directory) {
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() != ".glint") continue;
    found.emplace_back(entry.last_write_time(error), entry.path());
  }
  std::ranges::sort(found, std::ranges::greater{});
  std::vector<fs::path> files;
  files.reserve(found.size());
  for (auto& [time, file] : found) files.push_back(std::move(file));
  return files;
}

bool has_keyframes(const fs::path& file) {
  try {
    return slam::SessionReader(file).keyframe_count() > 0;
  } catch (const InputError& error) {
    spdlog::warn("map.on_start: {}", error.what());
    return false;
  }
}

}  // namespace

SessionPlan plan_session(const Config& config) {
  SessionPlan plan;
  plan.file = new_session_file(config);
  plan.search_s = config.map.search_s;
  if (config.map.on_start != "continue" || plan.file.empty()) return plan;
  const std::vector<fs::path> sessions = sessions_in(plan.file.parent_path());
  const auto latest = std::ranges::find_if(sessions, has_keyframes);
  if (latest == sessions.end()) {
    spdlog::info("map.on_start: there is no session to go on with; an empty map is begun");
    return plan;
  }
  plan.otherwise = plan.file;
  plan.file = plan.earlier = *latest;
  spdlog::info("going on with the map of {}", plan.earlier.string());
  return plan;
}

}  // namespace glint::daemon
