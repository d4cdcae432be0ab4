// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "driver/core/sensor_info.hpp"
#include "slam/config.hpp"
#include "slam/keyframe.hpp"
#include "slam/loop_edge.hpp"

namespace glint::slam {

/// An event for the session file: `data` is a JSON object.
struct SessionEvent {
  SensorTime stamp;
  std::string kind;
  std::string data;
};

/// What closing loops changes in the session file.
struct LoopChanges {
  std::vector<SessionEvent> events;
  std::vector<LoopEdge> added;
  std::vector<LoopEdge> removed;
  /// Keyframes and their new T_map_sensor.
  std::vector<std::pair<std::uint64_t, Pose>> poses;
};

/// The session file: one SQLite database (WAL) that holds each keyframe from the moment it is
/// added. Schema version 1: tables `meta` (key, value; says how poses and points are packed),
/// `keyframes`, `edges` (relative poses between keyframes with their covariance, of kind `odometry`
/// or `loop`), `events`.
/// Thread-compatible; owned by the back end.
class SessionStore {
 public:
  /// Creates the file, replacing one that is there. @throws InputError naming the file if it
  /// cannot.
  SessionStore(const std::filesystem::path& file, const SlamConfig& config);
  ~SessionStore();
  SessionStore(const SessionStore&) = delete;
  SessionStore& operator=(const SessionStore&) = delete;

  /// Commits whose scans the keyframes are of, in place of an earlier sensor. False as of add().
  [[nodiscard]] bool set_sensor(const SensorInfo& info);
  /// Commits a keyframe and the odometry edge to the one before it of the same segment. False when
  /// the file could not be written (disk full); error() then says why, and the next call tries
  /// anew.
  [[nodiscard]] bool add(const Keyframe& keyframe, const Pose& T_map_sensor);
  /// Commits all of it or, when it fails as add() can, none.
  [[nodiscard]] bool apply(const LoopChanges& changes);
  [[nodiscard]] std::string_view error() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint::slam
