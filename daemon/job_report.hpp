// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "daemon/config.hpp"

namespace glint::daemon {

enum class JobState { kRunning, kDone, kFailed, kCancelled };

/// "running", "done", "failed", "cancelled".
std::string_view to_string(JobState state);

/// How a job fares, or fared. Value type.
struct JobReport {
  std::uint64_t id = 0;  ///< From 1 on, in the order in which jobs began.
  std::string kind;      ///< What it does: the method that began it.
  JobState state = JobState::kRunning;
  double progress = 0.0;         ///< Share that is done, 0 to 1; never goes back.
  Json result = Json::object();  ///< Of one that is done.
  std::string error;             ///< Of one that failed or was cancelled: why, in a sentence.
};

/// The job as replies, events and the status tell it: `result` and `error` only where there is one.
Json job_json(const JobReport& report);

}  // namespace glint::daemon
