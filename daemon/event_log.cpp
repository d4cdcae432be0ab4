// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/event_log.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace glint::daemon {

void EventLog::post(Event event) {
  if (!event.fields.contains("t_host_ns")) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    event.fields["t_host_ns"] = std::chrono::nanoseconds(now).count();
  }
  const std::lock_guard lock(mutex_);
  events_.push_back(std::move(event));
  if (events_.size() <= capacity_) return;
  events_.pop_front();
  ++first_;
}

std::uint64_t EventLog::end() const {
  const std::lock_guard lock(mutex_);
  return first_ + events_.size();
}

std::optional<Event> EventLog::next(std::uint64_t& cursor) const {
  const std::lock_guard lock(mutex_);
  const std::uint64_t index = std::max(cursor, first_);
  if (index >= first_ + events_.size()) return std::nullopt;
  cursor = index + 1;
  return events_[index - first_];
}

}  // namespace glint::daemon
