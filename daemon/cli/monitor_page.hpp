// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "daemon/config.hpp"

namespace glint::cli {

/// What `glint watch --monitor` shows, made of the daemon's notifications. Thread-compatible.
class MonitorPage {
 public:
  explicit MonitorPage(std::string target) : target_(std::move(target)) {}

  /// A notification, as it came.
  void take(const daemon::Json& message);
  /// The connection was lost: what is shown is old. `why` is a sentence.
  void lose(std::string why);
  /// The page's lines, the most important ones first.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  [[nodiscard]] double per_second(const char* counter) const;
  void add_state(std::vector<std::string>& out) const;
  void add_flow(std::vector<std::string>& out) const;
  void add_map(std::vector<std::string>& out) const;
  void add_stages(std::vector<std::string>& out) const;

  const std::string target_;
  std::string problem_ = "connecting";  ///< Empty while the connection holds.
  daemon::Json pose_;
  daemon::Json status_;
  daemon::Json earlier_;            ///< The status that rates are told against.
  std::deque<std::string> events_;  ///< The latest one first.
};

}  // namespace glint::cli
