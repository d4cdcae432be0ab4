// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/stage_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace glint::cli {
namespace {

constexpr double kMsPerNs = 1e-6;

StageSummary summarize(std::vector<double> samples_ms) {
  StageSummary s;
  if (samples_ms.empty()) return s;
  std::sort(samples_ms.begin(), samples_ms.end());
  const auto count = static_cast<double>(samples_ms.size());
  s.mean = std::accumulate(samples_ms.begin(), samples_ms.end(), 0.0) / count;
  double squares = 0;
  for (const double v : samples_ms) squares += (v - s.mean) * (v - s.mean);
  s.std = std::sqrt(squares / count);
  // Nearest rank: the smallest sample that at least this share does not exceed.
  const auto rank = [&](double share) {
    return samples_ms[static_cast<std::size_t>(std::max(0.0, std::ceil(share * count) - 1))];
  };
  s.p50 = rank(0.50);
  s.p95 = rank(0.95);
  s.p99 = rank(0.99);
  s.max = samples_ms.back();
  return s;
}

}  // namespace

void StageStatistics::add(slam::Stage stage, std::int64_t wall_ns, std::int64_t cpu_ns) {
  const auto i = static_cast<std::size_t>(stage);
  wall_ms_[i].push_back(static_cast<double>(wall_ns) * kMsPerNs);
  cpu_ms_[i].push_back(static_cast<double>(cpu_ns) * kMsPerNs);
}

void StageStatistics::add(const slam::StageTimes& times) {
  for (std::size_t i = 0; i < slam::kStageCount; ++i) {
    if (times.wall_ns[i] > 0) add(static_cast<slam::Stage>(i), times.wall_ns[i], times.cpu_ns[i]);
  }
  const std::int64_t registration_ns =
      times.wall_ns[static_cast<std::size_t>(slam::Stage::kMatching)] +
      times.wall_ns[static_cast<std::size_t>(slam::Stage::kRegistration)];
  if (registration_ns > 0) {
    scan_registration_ms_.push_back(static_cast<double>(registration_ns) * kMsPerNs);
  }
}

StageSummary StageStatistics::wall(slam::Stage stage) const {
  return summarize(wall_ms_[static_cast<std::size_t>(stage)]);
}

StageSummary StageStatistics::cpu(slam::Stage stage) const {
  return summarize(cpu_ms_[static_cast<std::size_t>(stage)]);
}

std::array<std::pair<std::string_view, StageSummary>, 4> StageStatistics::paper_table() const {
  return {{{"features", wall(slam::Stage::kFeatures)},
           {"scan_registration", summarize(scan_registration_ms_)},
           {"map_optimization", wall(slam::Stage::kMapOptimization)},
           {"pgo", wall(slam::Stage::kPgo)}}};
}

nlohmann::ordered_json StageStatistics::to_json(bool cpu) const {
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < slam::kStageCount; ++i) {
    const StageSummary s = summarize((cpu ? cpu_ms_ : wall_ms_)[i]);
    json[std::string(slam::kStageNames[i])] = {{"mean", s.mean}, {"std", s.std}, {"p50", s.p50},
                                               {"p95", s.p95},   {"p99", s.p99}, {"max", s.max}};
  }
  return json;
}

}  // namespace glint::cli
