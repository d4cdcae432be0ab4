// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "daemon/log.hpp"
#include "daemon/runtime.hpp"

namespace glint::daemon {

/// Tells the log what changed since the last look: sensor and tracking state, and each counter of
/// things lost or discarded. Thread-compatible; the main thread's.
class HealthLog {
 public:
  void look(const RuntimeStatus& status, std::int64_t now_ns, std::int64_t scan_period_ns);

 private:
  void look_at_counter(const std::string& what, std::uint64_t value, std::int64_t now_ns);

  void look_at_mount(const ImuStatus& imu);

  LogLimiter limiter_;
  std::map<std::string, std::uint64_t> logged_;
  bool tilt_told_ = false;
  SourceState source_ = SourceState::kWaiting;
  slam::TrackingState tracking_ = slam::TrackingState::kInit;
};

}  // namespace glint::daemon
