// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// How a loop detector tells keyframes that show nothing new, and forgets them: what is known of a
// place does not grow with the times that it is passed.
#include <algorithm>
#include <cmath>

#include "slam/loops/loop_detector.hpp"
#include "slam/loops/same_view.hpp"

namespace glint::slam {
namespace {

// So far after a loop odometry still tells where among the older keyframes one is.
constexpr double kTied_m = 10.0;
// As near as this, and tilted by no more, a keyframe shows the same.
constexpr double kSameSpot_m = 0.5;
const double kLeastUpright = std::cos(10.0 * M_PI / 180.0);
// Keyframes on either side of the older one whose points are taken together with its own.
constexpr std::size_t kShownAround = 3;
// The last places are still looked at with each keyframe; so many known ones go at a time.
constexpr std::size_t kStillNeeded = 50;
constexpr std::size_t kForgottenAtOnce = 200;

bool is_upright(const Eigen::Quaterniond& turn) {
  return (turn * Eigen::Vector3d::UnitZ()).z() > kLeastUpright;
}

}  // namespace

std::optional<SeenBefore> LoopDetector::see_again() const {
  const Place& current = places_.back();
  if (!thins_ || evidence_.loops().empty()) return std::nullopt;
  const PlacePair& loop = evidence_.loops().back();
  if (loop.current.segment != current.segment || current.path_m - loop.current.path_m > kTied_m) {
    return std::nullopt;
  }
  // It may become the end of a loop yet.
  if (!waiting_.empty() && waiting_.back().pair.current.path_m == current.path_m) {
    return std::nullopt;
  }
  const Pose here = loop.older.T_odom_sensor * loop.T_older_current *
                    (loop.current.T_odom_sensor.inverse() * current.T_odom_sensor);
  const auto entry = nearest_older(loop, here);
  if (!entry) return std::nullopt;
  const Place& older = places_[*entry];
  const Pose T_older_current = older.T_odom_sensor.inverse() * here;
  if (contradicted(*entry, T_older_current)) return std::nullopt;
  const std::vector<Eigen::Vector3f> shown =
      points_of(around(*entry, kShownAround), older.T_odom_sensor.inverse());
  const std::span<const Eigen::Vector3f> points(current.points_m.data(), current.points_m.size());
  if (!shows_the_same(shown, points, T_older_current)) return std::nullopt;
  return SeenBefore{older.id, T_older_current};
}

// Of those about the older end of a loop, where the current one is `here` in their odometry.
std::optional<std::size_t> LoopDetector::nearest_older(const PlacePair& loop,
                                                       const Pose& here) const {
  std::optional<std::size_t> nearest;
  double least_m = kSameSpot_m;
  auto place =
      std::ranges::lower_bound(places_, loop.older.path_m - 2.0 * kTied_m, {}, &Place::path_m);
  for (; place != places_.end() && place->path_m < loop.older.path_m + 2.0 * kTied_m; ++place) {
    const auto entry = static_cast<std::size_t>(place - places_.begin());
    if (entry >= aged_) break;
    if (place->known || place->segment != loop.older.segment) continue;
    const Pose T_older_here = place->T_odom_sensor.inverse() * here;
    const double apart_m = T_older_here.translation_m.norm();
    if (apart_m >= least_m || !is_upright(T_older_here.rotation)) continue;
    nearest = entry;
    least_m = apart_m;
  }
  return nearest;
}

void LoopDetector::forget_known() {
  if (known_ < kForgottenAtOnce + kStillNeeded) return;
  const std::size_t end = places_.size() - kStillNeeded;
  // Of each place, and of the end.
  std::vector<std::size_t> number_now;
  number_now.reserve(places_.size() + 1);
  std::size_t left = 0;
  for (std::size_t entry = 0; entry < places_.size(); ++entry) {
    number_now.push_back(left);
    const bool goes = places_[entry].known && entry < end;
    if (goes) --known_;
    left += goes ? 0 : 1;
  }
  number_now.push_back(left);
  index_.renumber(number_now, left);
  if (density_) density_->renumber(number_now);
  for (Region& region : regions_) region.best = number_now[region.best];
  aged_ = number_now[aged_];
  cold_ = number_now[cold_];
  std::size_t entry = 0;
  std::erase_if(places_, [&](const Place& place) { return entry++ < end && place.known; });
}

}  // namespace glint::slam
