// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace glint::daemon {

/// Others ask the thread that owns the session to bring all that waits onto the disk. Thread-safe;
/// only who asks waits.
class CommitRequest {
 public:
  enum class Outcome { kDone, kFailed, kGivenUp };

  /// Asks and waits for the answer, as long as `wanted()`, which is called ten times a second and
  /// must not ask in turn.
  template <class Wanted>
  Outcome wait(Wanted wanted) {
    std::unique_lock lock(mutex_);
    const std::uint64_t mine = ++asked_;
    while (answered_ < mine && !closed_) {
      if (!wanted()) return Outcome::kGivenUp;
      changed_.wait_for(lock, kLook);
    }
    return done_ ? Outcome::kDone : Outcome::kFailed;
  }

  /// The owner's: calls `commit()`, which says whether it worked, if somebody waits for it.
  template <class Commit>
  void serve(Commit commit) {
    std::unique_lock lock(mutex_);
    const std::uint64_t serving = asked_;
    if (answered_ == serving) return;
    lock.unlock();
    const bool done = commit();
    lock.lock();
    answered_ = serving;
    done_ = done;
    changed_.notify_all();
  }

  /// The owner has ended, `done` says whether all is on the disk: that is every answer from here
  /// on. Counts only the first time.
  void close(bool done) {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    closed_ = true;
    done_ = done;
    changed_.notify_all();
  }

 private:
  static constexpr std::chrono::milliseconds kLook{100};

  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_:
  std::uint64_t asked_ = 0;
  std::uint64_t answered_ = 0;
  bool done_ = false;
  bool closed_ = false;
};

}  // namespace glint::daemon
