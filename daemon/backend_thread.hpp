// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>

#include "daemon/config.hpp"
#include "daemon/crossings.hpp"
#include "daemon/event_log.hpp"
#include "daemon/heartbeat.hpp"
#include "slam/backend.hpp"

namespace glint::daemon {

/// Body of the backend thread: keyframes to pose graph, map and session. Owned by that thread.
class BackendThread {
 public:
  /// `session_file`: empty for none; `loops` as Backend has it. @throws InputError when the file
  /// cannot be created.
  BackendThread(const Config& config, const std::filesystem::path& session_file,
                slam::LoopSource loops, Crossings& crossings, Heartbeat& heartbeat,
                EventLog& events);

  /// Until the keyframe queue is closed and empty.
  void run();

 private:
  void look_at_sensor();
  void process(const slam::Keyframe& keyframe);
  void keep_session();
  [[nodiscard]] bool commit_session();
  void tell(std::uint32_t epoch_before);
  void correct_last_snapshot();
  void publish();

  Crossings& crossings_;
  Heartbeat& heartbeat_;
  EventLog& events_;
  slam::Backend backend_;
  std::shared_ptr<const SensorInfo> sensor_;  ///< The one that the session file names.
  DurationStats duration_;
  DurationStats pgo_duration_;
};

}  // namespace glint::daemon
