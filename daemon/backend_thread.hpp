// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <memory>

#include "daemon/config.hpp"
#include "daemon/crossings.hpp"
#include "daemon/event_log.hpp"
#include "daemon/heartbeat.hpp"
#include "daemon/session_plan.hpp"
#include "slam/backend.hpp"

namespace glint::daemon {

/// Body of the backend thread: keyframes to pose graph, map and session. Owned by that thread.
class BackendThread {
 public:
  /// `make_loops`: what Backend takes; empty for none. @throws InputError when the session cannot
  /// be created, or gone on with.
  BackendThread(const Config& config, SessionPlan plan,
                std::function<slam::LoopSource()> make_loops, Crossings& crossings,
                Heartbeat& heartbeat, EventLog& events);

  /// Until the keyframe queue is closed and empty.
  void run();

 private:
  void look_at_sensor();
  void process(const slam::Keyframe& keyframe);
  void restore_more();
  void keep_session();
  [[nodiscard]] std::unique_ptr<slam::Backend> make_backend() const;
  [[nodiscard]] std::unique_ptr<slam::Backend> make_backend_stored_or_not();
  void change_map(const MapChange& change);
  void search_anew(const PlaceSearchRequest& request);
  void take_end_of_search();
  void begin_another_map();
  void post_map_event(const char* action);
  void tell(const slam::MapCorrection& before, const char* action = nullptr);
  [[nodiscard]] bool commit_session();
  void correct_last_snapshot();
  void publish();

  const slam::SlamConfig config_;
  const std::function<slam::LoopSource()> make_loops_;
  SessionPlan plan_;
  Crossings& crossings_;
  Heartbeat& heartbeat_;
  EventLog& events_;
  std::string no_session_because_;            ///< Empty: there is one, or none was asked for.
  std::unique_ptr<slam::Backend> backend_;    ///< Never null.
  bool told_not_found_ = false;               ///< Of the search that goes on.
  std::shared_ptr<const SensorInfo> sensor_;  ///< The one that the session file names.
  DurationStats duration_;
  DurationStats pgo_duration_;
};

}  // namespace glint::daemon
