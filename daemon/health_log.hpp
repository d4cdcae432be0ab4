// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "daemon/log.hpp"
#include "daemon/runtime.hpp"

namespace glint::daemon {

/// Tells the log what changed since the last look: state of the source and of tracking, and each
/// counter of things lost or discarded. Thread-compatible; the main thread's.
class HealthLog {
 public:
  void look(const RuntimeStatus& status, std::int64_t now_ns, std::int64_t scan_period_ns);
  /// The state of the packet source, also for the clients; left out where a session with the sensor
  /// tells it.
  void look_at_source(const RuntimeStatus& status, EventLog& events);

 private:
  void look_at_refusals(const RuntimeStatus& status, std::uint64_t refused, std::int64_t now_ns);
  /// `name`: as warn_of_counter() has it.
  void look_at_counter(const std::string& name, const std::string& what, std::uint64_t value,
                       std::int64_t now_ns);

  void look_at_mount(const ImuStatus& imu);

  LogLimiter limiter_;
  std::map<std::string, std::uint64_t> logged_;
  std::uint64_t refused_ = 0;
  bool tilt_told_ = false;
  SourceState source_ = SourceState::kWaiting;
  std::uint32_t map_epoch_ = 0;
  slam::TrackingState tracking_ = slam::TrackingState::kInit;
};

}  // namespace glint::daemon
