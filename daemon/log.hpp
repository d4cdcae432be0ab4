// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace glint::daemon {

/// Sends spdlog's default logger to standard error: with the journal's priority prefix when the
/// journal reads it, with times otherwise.
void set_up_logging(const std::string& level);
/// debug, info, warn or error.
void set_log_level(const std::string& level);

/// Warns that a counter has risen by `added` to `value`. In the journal the entry has the fields
/// GLINT_COUNTER (its name among the status's `counters`, or its path in the status), GLINT_ADDED
/// and GLINT_VALUE beside its text.
void warn_of_counter(const std::string& text, const std::string& counter, std::uint64_t added,
                     std::uint64_t value);

/// At most one line per cause in ten seconds, whatever happens how often. Thread-compatible.
class LogLimiter {
 public:
  /// True when a line about `cause` may be logged at steady time `now_ns`.
  bool allow(const std::string& cause, std::int64_t now_ns);

 private:
  std::map<std::string, std::int64_t> last_ns_;
};

}  // namespace glint::daemon
