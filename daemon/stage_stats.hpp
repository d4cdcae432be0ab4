// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "slam/stage_times.hpp"

namespace glint::daemon {

/// Count, last, mean and largest of a duration. Value type.
struct DurationStats {
  std::uint64_t count = 0;
  std::int64_t last_ns = 0;
  std::int64_t sum_ns = 0;
  std::int64_t max_ns = 0;

  void add(std::int64_t ns) {
    ++count;
    last_ns = ns;
    sum_ns += ns;
    max_ns = std::max(max_ns, ns);
  }
};

/// Wall time of each stage since the start, by slam::Stage. Value type.
struct StageStats {
  std::array<DurationStats, slam::kStageCount> stages{};

  DurationStats& operator[](slam::Stage stage) { return stages[static_cast<std::size_t>(stage)]; }
};

}  // namespace glint::daemon
