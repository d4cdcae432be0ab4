// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "slam/stage_times.hpp"

namespace glint::cli {

/// Mean, spread and quantiles of a stage's times, milliseconds.
struct StageSummary {
  double mean = 0, std = 0, p50 = 0, p95 = 0, p99 = 0, max = 0;
};

/// Collects the stage times of every scan of a replay. A stage counts the scans in which it ran.
class StageStatistics {
 public:
  void add(slam::Stage stage, std::int64_t wall_ns, std::int64_t cpu_ns);
  /// Adds all stages of one scan but those that did not run (zero).
  void add(const slam::StageTimes& times);

  [[nodiscard]] StageSummary wall(slam::Stage stage) const;
  [[nodiscard]] StageSummary cpu(slam::Stage stage) const;
  /// What the paper's own table has, by wall: features, scan registration (with matching), map
  /// optimisation, PGO.
  [[nodiscard]] std::array<std::pair<std::string_view, StageSummary>, 4> paper_table() const;
  /// `summary.json`'s object: stage name -> {mean, std, p50, p95, p99, max}.
  [[nodiscard]] nlohmann::ordered_json to_json(bool cpu) const;

 private:
  using Samples = std::array<std::vector<double>, slam::kStageCount>;
  Samples wall_ms_;
  Samples cpu_ms_;
  std::vector<double> scan_registration_ms_;  ///< Matching and registration together, wall.
};

}  // namespace glint::cli
