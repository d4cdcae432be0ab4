// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "slam/stage_times.hpp"

namespace glint::daemon {

/// Upper bounds of the counted durations; what is longer than all of them has no bucket.
constexpr std::array<std::int64_t, 13> kDurationBounds_ns = {
    100'000,    250'000,    500'000,     1'000'000,   2'500'000,   5'000'000,    10'000'000,
    25'000'000, 50'000'000, 100'000'000, 250'000'000, 500'000'000, 1'000'000'000};

/// Count, last, mean, largest and distribution of a duration. Value type.
struct DurationStats {
  std::uint64_t count = 0;
  std::int64_t last_ns = 0;
  std::int64_t sum_ns = 0;
  std::int64_t max_ns = 0;
  /// By the first of kDurationBounds_ns that is not less.
  std::array<std::uint64_t, kDurationBounds_ns.size()> buckets{};

  void add(std::int64_t ns) {
    ++count;
    last_ns = ns;
    sum_ns += ns;
    max_ns = std::max(max_ns, ns);
    const auto* bound = std::ranges::lower_bound(kDurationBounds_ns, ns);
    if (bound == kDurationBounds_ns.end()) return;
    ++buckets[static_cast<std::size_t>(bound - kDurationBounds_ns.begin())];
  }
};

/// Wall time of each stage since the start, by slam::Stage. Value type.
struct StageStats {
  std::array<DurationStats, slam::kStageCount> stages{};

  DurationStats& operator[](slam::Stage stage) { return stages[static_cast<std::size_t>(stage)]; }
};

}  // namespace glint::daemon
