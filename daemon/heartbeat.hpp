// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <atomic>
#include <cstdint>

#include "daemon/steady_clock.hpp"

namespace glint::daemon {

/// Sign of life of one thread, for the watchdog. Thread-safe.
class Heartbeat {
 public:
  void beat() { last_ns_.store(steady_now_ns(), std::memory_order_relaxed); }
  /// The thread has ended as it should: fresh for ever.
  void finish() { finished_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool fresh(std::int64_t now_ns, std::int64_t limit_ns) const {
    return finished_.load(std::memory_order_relaxed) ||
           now_ns - last_ns_.load(std::memory_order_relaxed) < limit_ns;
  }

 private:
  std::atomic<std::int64_t> last_ns_{steady_now_ns()};
  std::atomic<bool> finished_{false};
};

}  // namespace glint::daemon
