// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/job_board.hpp"

#include <spdlog/spdlog.h>

#include <utility>

namespace glint::daemon {
namespace {

constexpr std::int64_t kProgressPeriodNs = 200'000'000;

bool is_running(const std::deque<JobReport>& latest) {
  return !latest.empty() && latest.front().state == JobState::kRunning;
}

void log_job(const JobReport& job) {
  const auto level = job.state == JobState::kFailed ? spdlog::level::warn : spdlog::level::info;
  spdlog::log(level, "job {} ({}): {}{}{}", job.id, job.kind, to_string(job.state),
              job.error.empty() ? "" : ": ", job.error);
}

}  // namespace

std::string_view to_string(JobState state) {
  switch (state) {
    case JobState::kRunning:
      return "running";
    case JobState::kDone:
      return "done";
    case JobState::kFailed:
      return "failed";
    case JobState::kCancelled:
      return "cancelled";
  }
  return "failed";
}

Json job_json(const JobReport& report) {
  Json out{{"id", report.id},
           {"kind", report.kind},
           {"state", to_string(report.state)},
           {"progress", report.progress}};
  if (report.state == JobState::kDone) out["result"] = report.result;
  if (!report.error.empty()) out["error"] = report.error;
  return out;
}

std::shared_ptr<RunningJob> JobBoard::begin(const std::string& kind) {
  JobReport report;
  {
    const std::lock_guard lock(mutex_);
    if (closed_ || is_running(latest_)) return nullptr;
    report.id = ++begun_;
    report.kind = kind;
    // Whoever asks from here on finds one running.
    latest_.push_front(report);
    if (latest_.size() > kKept) latest_.pop_back();
  }
  auto job =
      std::make_shared<RunningJob>(report, [this](const JobReport& changed) { take(changed); });
  const std::lock_guard lock(mutex_);
  running_ = job;
  if (closed_) job->give_up();
  return job;
}

void JobBoard::take(const JobReport& report) {
  const std::lock_guard lock(mutex_);
  const bool begins = report.progress == 0.0 && report.state == JobState::kRunning;
  const bool turns = begins || report.state != JobState::kRunning;
  latest_.front() = report;
  if (turns) log_job(report);
  const std::int64_t now_ns = clock_.monotonic_ns();
  if (!turns && now_ns - last_event_ns_ < kProgressPeriodNs) return;
  last_event_ns_ = now_ns;
  events_.post({"job", 0, Json{{"job", job_json(report)}}});
}

std::vector<JobReport> JobBoard::latest() const {
  const std::lock_guard lock(mutex_);
  return {latest_.begin(), latest_.end()};
}

std::optional<JobReport> JobBoard::running() const {
  const std::lock_guard lock(mutex_);
  if (!is_running(latest_)) return std::nullopt;
  return latest_.front();
}

void JobBoard::close() {
  std::shared_ptr<RunningJob> job;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    job = running_.lock();
  }
  // Without the lock: should this be the last to hold the job, its end is told to take().
  if (job) job->give_up();
}

}  // namespace glint::daemon
