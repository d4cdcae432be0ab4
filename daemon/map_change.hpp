// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "daemon/running_job.hpp"
#include "daemon/session_plan.hpp"

namespace glint::daemon {

/// Another map to go on with from here on.
struct MapChange {
  SessionPlan plan;
  std::shared_ptr<RunningJob> job;  ///< Ends when the map is there, or cannot be; never null.
};

/// From whoever wants another map to the back end. Holds one change, for one job runs at a time.
/// Thread-safe; nobody waits.
class MapChangeSlot {
 public:
  /// After close() the change is dropped, and its job with it.
  void post(MapChange change) {
    const std::lock_guard lock(mutex_);
    if (!closed_) change_ = std::move(change);
  }
  [[nodiscard]] std::optional<MapChange> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(change_, std::nullopt);
  }
  /// What is there, and all that comes, is given up.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    if (change_) change_->job->cancel();
    change_.reset();
  }

 private:
  std::mutex mutex_;
  std::optional<MapChange> change_;
  bool closed_ = false;
};

}  // namespace glint::daemon
