// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

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

}  // namespace glint::slam
