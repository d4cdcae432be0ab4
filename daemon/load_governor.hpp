// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <algorithm>

#include "slam/load_level.hpp"

namespace glint::daemon {

/// Chooses what odometry leaves out, by how far it lags behind the sensor: more when it stays
/// behind (a burst or a hiccup it catches up with), less after some seconds with time to spare.
/// Thread-compatible.
class LoadGovernor {
 public:
  /// After each scan: what it took and how many scans' packets wait, for scans every `period_s`.
  slam::LoadLevel after_scan(double took_s, double waiting_scans, double period_s) {
    const bool late = waiting_scans > kLate_scans;
    const bool easy = waiting_scans < kEasy_scans && took_s < kEasyShare * period_s;
    spare_s_ = easy ? spare_s_ + period_s : 0.0;
    late_scans_ = late ? late_scans_ + 1 : 0;
    if (late_scans_ >= kPatience_scans) {
      step(+1);
    } else if (spare_s_ > kSpare_s) {
      step(-1);
    }
    return static_cast<slam::LoadLevel>(level_);
  }

 private:
  static constexpr double kLate_scans = 2.0;
  static constexpr double kEasy_scans = 0.5;
  static constexpr double kEasyShare = 0.6;
  static constexpr double kSpare_s = 5.0;
  // As many scans as a level needs to show its effect, too.
  static constexpr int kPatience_scans = 4;

  void step(int by) {
    level_ = std::clamp(level_ + by, 0, static_cast<int>(slam::kLoadLevels) - 1);
    late_scans_ = 0;
    spare_s_ = 0.0;
  }

  int level_ = 0;
  int late_scans_ = 0;
  double spare_s_ = 0.0;
};

}  // namespace glint::daemon
