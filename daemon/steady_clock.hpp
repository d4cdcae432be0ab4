// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <ctime>

#include "driver/core/clock.hpp"
#include "driver/core/time.hpp"

namespace glint::daemon {

inline std::int64_t read_clock_ns(clockid_t id) {
  timespec t{};
  clock_gettime(id, &t);
  return std::int64_t{t.tv_sec} * kNsPerSecond + t.tv_nsec;
}

/// Time that no one sets, ns: for ages, timeouts and stage times.
inline std::int64_t steady_now_ns() { return read_clock_ns(CLOCK_MONOTONIC); }

/// The clock that the libraries are given for measuring their stages.
inline Clock stage_clock() {
  return {[] { return read_clock_ns(CLOCK_MONOTONIC); },
          [] { return read_clock_ns(CLOCK_THREAD_CPUTIME_ID); }};
}

}  // namespace glint::daemon
