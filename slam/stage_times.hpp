// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "driver/core/clock.hpp"

namespace glint::slam {

/// The timed stages of one scan's way. The names are those of summary.json.
enum class Stage {
  kDecode,
  kImage,
  kFeatures,
  kMatching,
  kRegistration,
  kMapOptimization,
  kPgo,
  kBackend,
  kTotal
};
constexpr std::size_t kStageCount = 9;
constexpr std::array<std::string_view, kStageCount> kStageNames = {
    "decode",           "image", "features", "matching", "registration",
    "map_optimization", "pgo",   "backend",  "total"};

/// What each stage took for one scan, by the wall and by the thread's CPU clock.
struct StageTimes {
  std::array<std::int64_t, kStageCount> wall_ns{};
  std::array<std::int64_t, kStageCount> cpu_ns{};
};

/// Adds the time from its construction to its end to one stage. Stages may nest.
class StageTimer {
 public:
  StageTimer(const Clock& clock, StageTimes& times, Stage stage)
      : clock_(clock),
        times_(times),
        stage_(static_cast<std::size_t>(stage)),
        wall_start_ns_(clock.monotonic_ns()),
        cpu_start_ns_(clock.thread_cpu_ns()) {}
  ~StageTimer() {
    times_.wall_ns[stage_] += clock_.monotonic_ns() - wall_start_ns_;
    times_.cpu_ns[stage_] += clock_.thread_cpu_ns() - cpu_start_ns_;
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  const Clock& clock_;
  StageTimes& times_;
  std::size_t stage_;
  std::int64_t wall_start_ns_;
  std::int64_t cpu_start_ns_;
};

}  // namespace glint::slam
