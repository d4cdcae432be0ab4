// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "daemon/config.hpp"

namespace glint::daemon {

/// Something that happened and that a client may want to know at once. Value type.
struct Event {
  std::string kind;              ///< What it is about: "clock", "sensor", "tracking", ...
  int sensor = 0;                ///< Which sensor it is about.
  Json fields = Json::object();  ///< What there is to tell; becomes part of the notification.
};

/// The latest events of the whole program, numbered from its start. Bounded: the oldest go, and a
/// reader that is too late for them learns how many. Thread-safe; nobody waits longer than a copy.
class EventLog {
 public:
  explicit EventLog(std::size_t capacity = 256) : capacity_(capacity) {}

  /// Keeps an event. Its fields get the time of this machine, `t_host_ns`, unless they have one.
  void post(Event event);

  /// One past the newest event: where a reader begins that wants only what is to come.
  [[nodiscard]] std::uint64_t end() const;
  /// The event `cursor`, or the oldest one kept if that is newer; null when there is none yet.
  /// `cursor` steps past the event, so it tells how many were left out.
  [[nodiscard]] std::optional<Event> next(std::uint64_t& cursor) const;

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::deque<Event> events_;  ///< Guarded by mutex_, as is:
  std::uint64_t first_ = 0;   ///< Number of the oldest event kept.
};

}  // namespace glint::daemon
