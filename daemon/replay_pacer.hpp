// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "driver/core/time.hpp"

namespace glint::daemon {

/// Paces a replay by the capture's record times, sped up by a factor. Deadlines are absolute, so
/// delays do not add up. Give PcapSource a lambda that calls it: `[&](HostTime t) { return
/// pacer.wait(t); }`. Thread-compatible.
class ReplayPacer {
 public:
  /// `rate` 1 is the speed of recording, 2 twice as fast; above 0.
  explicit ReplayPacer(double rate) : rate_(rate) {}

  /// Sleeps until a packet recorded at `time` is due, but at most 100 ms; true when it is due.
  /// The first packet is due at once, as is one whose time is before that of the first.
  bool wait(HostTime time);

  /// The next packet is a first one again: the capture starts over.
  void restart() { start_.reset(); }

 private:
  struct Start {
    HostTime recorded;
    std::int64_t steady_ns;
  };
  const double rate_;
  std::optional<Start> start_;
};

/// The value of --rate: null for "max", else a number above 0.
/// @throws InputError with a sentence when it is neither.
std::optional<double> parse_rate(std::string_view text);

}  // namespace glint::daemon
