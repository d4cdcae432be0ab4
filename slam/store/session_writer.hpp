// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <span>

#include "slam/store/database.hpp"
#include "slam/store/session_record.hpp"
#include "slam/store/statement.hpp"

namespace glint::slam {

/// Puts records into the tables, in the caller's transaction. Thread-compatible; every member
/// throws SqlError.
class SessionWriter {
 public:
  explicit SessionWriter(const Database& database);

  /// Events, new edges and removed ones of LoopChanges; its poses are left to move().
  void write(const SessionRecord& record);
  /// The keyframe's pose in the map is another one now; nothing happens if there is none of that
  /// id.
  void move(std::uint64_t id, const Pose& T_map_sensor);

 private:
  void put(const KeyframeRecord& keyframe);
  void put(const MetaRecord& meta);
  void put(const SensorRecord& sensor);
  void put(const LoopChanges& changes);
  void put_edge(const LoopEdge& edge, const char* kind);

  Statement add_keyframe_;
  Statement add_points_;
  Statement add_features_;
  Statement add_words_;
  Statement add_edge_;
  Statement remove_loop_;
  Statement add_event_;
  Statement put_meta_;
  Statement put_sensor_;
  Statement move_;
};

}  // namespace glint::slam
