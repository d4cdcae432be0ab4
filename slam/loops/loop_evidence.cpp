// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/loop_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

// Drift between two keyframes, beyond which pairs do not agree.
constexpr double kApart_m = 0.3;
constexpr double kApartShare = 0.02;
constexpr double kApart_rad = 0.09;
constexpr double kApart_rad_per_m = 0.001;
// What lies farther back than this no longer counts.
constexpr double kReach_m = 5.0;
constexpr int kEnough = 4;
constexpr double kEnoughWay_m = 1.5;
constexpr int kWorst = -4;

// A loop tells of keyframes within this way of its own.
constexpr double kLoopReach_m = 15.0;
// Over so long a way the last loop says where others can be.
constexpr double kLoopMemory_m = 30.0;

double way_between(const PlacePair& a, const PlacePair& b) {
  return std::abs(a.older.path_m - b.older.path_m) + std::abs(a.current.path_m - b.current.path_m);
}

bool agree_by_odometry(const PlacePair& a, const PlacePair& b) {
  if (a.older.segment != b.older.segment || a.current.segment != b.current.segment) return false;
  const Pose T_older = a.older.T_odom_sensor.inverse() * b.older.T_odom_sensor;
  const Pose T_current = a.current.T_odom_sensor.inverse() * b.current.T_odom_sensor;
  const Pose apart = (a.T_older_current * T_current).inverse() * (T_older * b.T_older_current);
  const double way_m = way_between(a, b);
  return apart.translation_m.norm() < kApart_m + kApartShare * way_m &&
         so3_log(apart.rotation).norm() < kApart_rad + kApart_rad_per_m * way_m;
}

}  // namespace

bool LoopEvidence::agree(const PlacePair& a, const PlacePair& b) const {
  if (agree_by_odometry(a, b)) return true;
  // What the two say of the older keyframes.
  const bool in_order = a.older.path_m < b.older.path_m;
  const PlacePair& first = in_order ? a : b;
  const PlacePair& second = in_order ? b : a;
  const Pose T_current = first.current.T_odom_sensor.inverse() * second.current.T_odom_sensor;
  const PlacePair between{first.older, second.older,
                          first.T_older_current * T_current * second.T_older_current.inverse()};
  return std::ranges::any_of(loops_, [&](const PlacePair& loop) {
    return way_between(loop, between) < kLoopReach_m && agree_by_odometry(loop, between);
  });
}

bool LoopEvidence::about(const PlacePair& pair) const {
  return last_ && pair.current.path_m - last_->current.path_m < kReach_m && agree(*last_, pair);
}

void LoopEvidence::speak_for(const PlacePair& pair) {
  if (!about(pair)) {
    balance_ = 0;
    since_m_ = pair.current.path_m;
  }
  ++balance_;
  last_ = pair;
}

void LoopEvidence::speak_against(const PlacePair& pair) {
  if (!about(pair)) {
    // What speaks against another loop is none of this one's business.
    if (balance_ > 0 && last_ && pair.current.path_m - last_->current.path_m < kReach_m) return;
    balance_ = 0;
  }
  balance_ = std::max(kWorst, balance_ - 1);
  since_m_ = pair.current.path_m;
  last_ = pair;
}

bool LoopEvidence::convincing(const PlacePair& pair, double times) const {
  return balance_ >= times * kEnough && pair.current.path_m - since_m_ >= times * kEnoughWay_m;
}

std::optional<bool> LoopEvidence::foreseen(const PlacePair& pair) const {
  if (loops_.empty() || pair.current.path_m - loops_.back().current.path_m > kLoopMemory_m) {
    return std::nullopt;
  }
  return agree(loops_.back(), pair);
}

}  // namespace glint::slam
