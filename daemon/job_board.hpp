// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/event_log.hpp"
#include "daemon/job_report.hpp"
#include "daemon/running_job.hpp"
#include "daemon/steady_clock.hpp"

namespace glint::daemon {

/// The jobs of the program: work that takes longer than a client waits for a reply. One runs at a
/// time, so that two never work on the map against each other. How it fares is told in events of
/// kind `job`: its begin, its end, and between them at most five a second.
///
/// Who does the work does not matter. Runtime::start_job() runs a function on the jobs thread;
/// work that belongs to another thread begins its job here and hands it over:
///
///     std::shared_ptr<RunningJob> job = runtime.jobs().begin("load_map");  // main: null is BUSY
///     reply(job_json(job->report()));
///     runtime.post_to_backend({file, job});          // whatever way the thread is told things
///     ...
///     if (!job->progress(0.4)) return job->cancel(); // there, as often as it likes
///     job->done(Json{{"keyframes", 812}});           // or job->fail("why, in a sentence")
///
/// A job must end before its board does: whatever can hold one is to be destroyed first.
/// Thread-safe; nobody waits.
class JobBoard {
 public:
  explicit JobBoard(EventLog& events, Clock clock = stage_clock())
      : events_(events), clock_(clock) {}

  /// Null while another job runs, and after close().
  [[nodiscard]] std::shared_ptr<RunningJob> begin(const std::string& kind);
  /// The newest ones, the last begun first.
  [[nodiscard]] std::vector<JobReport> latest() const;
  [[nodiscard]] std::optional<JobReport> running() const;
  /// None begins any more, and the one that runs is to be given up.
  void close();

  /// So many are remembered.
  static constexpr std::size_t kKept = 8;

 private:
  void take(const JobReport& report);

  EventLog& events_;
  const Clock clock_;
  mutable std::mutex mutex_;
  // Guarded by mutex_:
  std::deque<JobReport> latest_;
  std::weak_ptr<RunningJob> running_;
  std::uint64_t begun_ = 0;
  std::int64_t last_event_ns_ = 0;
  bool closed_ = false;
};

}  // namespace glint::daemon
