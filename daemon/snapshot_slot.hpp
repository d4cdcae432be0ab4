// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace glint::daemon {

/// The latest immutable value of one writer, for any number of readers. Neither waits longer than a
/// pointer's copy. (std::atomic<shared_ptr> would do the same, but the thread sanitizer of g++ 12
/// reports a race inside it.) Thread-safe.
template <class T>
class SnapshotSlot {
 public:
  void store(std::shared_ptr<const T> value) {
    {
      const std::lock_guard lock(mutex_);
      value_.swap(value);
    }
    // The old value, if this was its last owner, is destroyed here, outside the lock.
  }

  /// Null before the first store().
  [[nodiscard]] std::shared_ptr<const T> load() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const T> value_;
};

}  // namespace glint::daemon
