// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <variant>
#include <vector>

#include "driver/core/sensor_info.hpp"
#include "slam/map_correction.hpp"

namespace glint::daemon {

struct PauseCommand {};
struct ResumeCommand {};
/// Forget the odometry, keep the map.
struct ResetOdometryCommand {};

/// Whose packets come from here on: known at last, or changed.
struct UseSensorCommand {
  std::shared_ptr<const SensorInfo> info;  ///< Never null.
  /// It was said by the sensor itself, so packets of another of its starts are not of this layout
  /// for certain.
  bool this_start = false;
};

/// What others tell odometry; applied between two scans.
using Command = std::variant<PauseCommand, ResumeCommand, ResetOdometryCommand, UseSensorCommand,
                             slam::MapCorrection>;

/// Commands to the odometry thread, in order of arrival. Thread-safe; nobody waits.
class CommandMailbox {
 public:
  void post(Command command) {
    const std::lock_guard lock(mutex_);
    commands_.push_back(std::move(command));
  }

  /// Everything posted since the last call.
  [[nodiscard]] std::vector<Command> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(commands_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<Command> commands_;
};

}  // namespace glint::daemon
