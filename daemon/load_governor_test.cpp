// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/load_governor.hpp"

#include <gtest/gtest.h>

namespace glint::daemon {
namespace {

using slam::LoadLevel;

constexpr double kPeriod_s = 0.05;

/// A machine that needs so much for each scan at each level, with a sensor that does not wait.
LoadLevel run(LoadGovernor& governor, const std::array<double, slam::kLoadLevels>& took_s,
              int scans, LoadLevel level, double* waiting_scans) {
  for (int i = 0; i < scans; ++i) {
    const double took = took_s[static_cast<std::size_t>(level)];
    *waiting_scans = std::max(0.0, *waiting_scans + took / kPeriod_s - 1.0);
    level = governor.after_scan(took, *waiting_scans, kPeriod_s);
  }
  return level;
}

TEST(LoadGovernor, NothingIsLeftOutOnAMachineThatKeepsUp) {
  LoadGovernor governor;
  double waiting_scans = 0.0;
  EXPECT_EQ(run(governor, {0.045, 0, 0, 0, 0}, 1000, LoadLevel::kFull, &waiting_scans),
            LoadLevel::kFull);
}

TEST(LoadGovernor, ABurstIsNoOverload) {
  LoadGovernor governor;
  double waiting_scans = 3.0;
  EXPECT_EQ(run(governor, {0.02, 0, 0, 0, 0}, 100, LoadLevel::kFull, &waiting_scans),
            LoadLevel::kFull);
}

TEST(LoadGovernor, AsMuchIsLeftOutAsIsNeeded) {
  LoadGovernor governor;
  double waiting_scans = 0.0;
  const std::array<double, slam::kLoadLevels> took_s = {0.08, 0.07, 0.06, 0.045, 0.03};
  const LoadLevel level = run(governor, took_s, 40, LoadLevel::kFull, &waiting_scans);
  EXPECT_GE(level, LoadLevel::kFewerPoints);
  // Whatever it settles at, the queue does not grow.
  run(governor, took_s, 400, level, &waiting_scans);
  EXPECT_LT(waiting_scans, 8.0);
}

TEST(LoadGovernor, AllComesBackOnceThereIsTimeToSpare) {
  LoadGovernor governor;
  double waiting_scans = 0.0;
  const LoadLevel busy =
      run(governor, {0.2, 0.2, 0.2, 0.2, 0.2}, 60, LoadLevel::kFull, &waiting_scans);
  EXPECT_EQ(busy, LoadLevel::kKeypointsEverySecond);
  const std::array<double, slam::kLoadLevels> idle = {0.02, 0.02, 0.02, 0.02, 0.02};
  EXPECT_EQ(run(governor, idle, 2000, busy, &waiting_scans), LoadLevel::kFull);
}

}  // namespace
}  // namespace glint::daemon
