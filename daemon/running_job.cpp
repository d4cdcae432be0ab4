// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/running_job.hpp"

#include <algorithm>
#include <utility>

namespace glint::daemon {

RunningJob::RunningJob(JobReport begun, Tell tell)
    : tell_(std::move(tell)), report_(std::move(begun)) {
  tell_(report_);
}

RunningJob::~RunningJob() {
  try {
    given_up_ ? cancel() : fail("the work was dropped before it was done");
  } catch (const std::exception&) {
    // There is no memory for telling it, nor anybody left to hear it.
  }
}

bool RunningJob::progress(double share) {
  const std::lock_guard lock(mutex_);
  if (report_.state == JobState::kRunning && share > report_.progress) {
    report_.progress = std::min(share, 1.0);
    tell_(report_);
  }
  return !given_up_;
}

void RunningJob::done(Json result) { end(JobState::kDone, std::move(result), {}); }

void RunningJob::fail(const std::string& why) { end(JobState::kFailed, Json::object(), why); }

void RunningJob::cancel() {
  end(JobState::kCancelled, Json::object(), "given up, for the daemon stops");
}

JobReport RunningJob::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

void RunningJob::end(JobState state, Json result, std::string error) {
  const std::lock_guard lock(mutex_);
  if (report_.state != JobState::kRunning) return;
  report_.state = state;
  if (state == JobState::kDone) report_.progress = 1.0;
  report_.result = std::move(result);
  report_.error = std::move(error);
  tell_(report_);
}

}  // namespace glint::daemon
