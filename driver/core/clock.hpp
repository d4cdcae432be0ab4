// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

namespace glint {

/// The clock a library may use for measuring its own stages, given by its caller: libraries read no
/// clock themselves. The default stands still, so that every measured time is 0.
struct Clock {
  /// Monotonic time, nanoseconds.
  std::int64_t (*monotonic_ns)() = [] { return std::int64_t{0}; };
  /// CPU time of the calling thread, nanoseconds.
  std::int64_t (*thread_cpu_ns)() = [] { return std::int64_t{0}; };
};

}  // namespace glint
