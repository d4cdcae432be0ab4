// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/replay_pacer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ctime>

#include "daemon/steady_clock.hpp"
#include "driver/core/error.hpp"

namespace glint::daemon {
namespace {

/// Short enough for a stop to be noticed.
constexpr std::int64_t kLongestSleepNs = kNsPerSecond / 10;

void sleep_until(std::int64_t steady_ns) {
  const timespec deadline{steady_ns / kNsPerSecond, steady_ns % kNsPerSecond};
  // A signal wakes early; the caller looks at the time again anyhow.
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr);
}

}  // namespace

bool ReplayPacer::wait(HostTime time) {
  const std::int64_t now_ns = steady_now_ns();
  if (!start_) start_ = Start{time, now_ns};
  const double since_start_ns = static_cast<double>(time - start_->recorded) / rate_;
  const std::int64_t due_ns = start_->steady_ns + std::llround(since_start_ns);
  if (due_ns > now_ns) sleep_until(std::min(due_ns, now_ns + kLongestSleepNs));
  return due_ns <= now_ns || steady_now_ns() >= due_ns;
}

std::optional<double> parse_rate(std::string_view text) {
  if (text == "max") return std::nullopt;
  double rate = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), rate);
  if (error == std::errc() && end == text.data() + text.size() && rate > 0.0 &&
      std::isfinite(rate)) {
    return rate;
  }
  throw InputError(
      fmt::format("The rate \"{}\" is neither max nor a number above 0; 1 replays at "
                  "the speed of recording.",
                  text));
}

}  // namespace glint::daemon
