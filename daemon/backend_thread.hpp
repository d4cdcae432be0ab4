// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>

#include "daemon/config.hpp"
#include "daemon/crossings.hpp"
#include "daemon/heartbeat.hpp"
#include "slam/backend.hpp"

namespace glint::daemon {

/// Body of the backend thread: keyframes to map and session. Owned by that thread.
class BackendThread {
 public:
  /// `session_file`: empty for none. @throws InputError when it cannot be created.
  BackendThread(const Config& config, const std::filesystem::path& session_file,
                Crossings& crossings, Heartbeat& heartbeat);

  /// Until the keyframe queue is closed and empty.
  void run();

 private:
  void look_at_sensor();
  void process(const slam::Keyframe& keyframe);
  void publish();

  Crossings& crossings_;
  Heartbeat& heartbeat_;
  slam::Backend backend_;
  std::shared_ptr<const SensorInfo> sensor_;  ///< The one that the session file names.
  DurationStats duration_;
};

}  // namespace glint::daemon
