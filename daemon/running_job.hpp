// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>

#include "daemon/job_report.hpp"

namespace glint::daemon {

/// The working side of a job that JobBoard began: whoever does the work reports through it, from
/// any thread. It ends once, with done(), fail() or cancel(); what is said after that is not heard.
/// One that is dropped before has failed. Thread-safe; nobody waits.
class RunningJob {
 public:
  /// Takes each report that differs from the one before, in order.
  using Tell = std::function<void(const JobReport& report)>;

  RunningJob(JobReport begun, Tell tell);
  ~RunningJob();
  RunningJob(const RunningJob&) = delete;
  RunningJob& operator=(const RunningJob&) = delete;

  /// The share that is done, 0 to 1. False when the work is to be given up: then end it soon, with
  /// cancel(). To be called a few times a second where that is possible.
  [[nodiscard]] bool progress(double share);
  void done(Json result);
  void fail(const std::string& why);
  void cancel();

  [[nodiscard]] JobReport report() const;
  /// From here on progress() is false. For the board.
  void give_up() { given_up_ = true; }

 private:
  void end(JobState state, Json result, std::string error);

  const Tell tell_;
  std::atomic<bool> given_up_{false};
  mutable std::mutex mutex_;
  JobReport report_;  ///< Guarded by mutex_.
};

}  // namespace glint::daemon
