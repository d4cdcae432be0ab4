// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/density_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::slam {
namespace {

// Keyframes before and after an older one, and twice as many before the current one, whose points
// make the map.
constexpr std::size_t kMapReach = 10;
// A map is kept each time when so many keyframes have passed.
constexpr std::size_t kMapEvery = 4;
// Those with more way than this between them are no neighbours: places were taken out there.
constexpr double kLongestGap_m = 5.0;
// Proposals this near to a better one (in keyframes) say the same.
constexpr std::size_t kSameReach = 12;
constexpr std::size_t kMostProposals = 2;
// Maps from so far away, in cells, and as much farther as odometry may have erred by, are compared.
constexpr float kReach_cells = 50.0F;
constexpr float kCoarsest_m = 0.8F;
// What odometry may have erred by. A storey is higher than twice kFloorGate_m.
constexpr double kFloorGate_m = 1.25;
constexpr double kMostShift_m = 3.0;
constexpr double kMostShiftShare = 0.02;
constexpr double kMostYaw_rad = 0.5;

Pose upright(const Place& place) { return {place.T_odom_sensor.rotation, Eigen::Vector3d::Zero()}; }

double most_shift_m(const Place& older, const Place& current) {
  return kMostShift_m + kMostShiftShare * (current.path_m - older.path_m);
}

bool leaves_room(const Place& older, const Place& current, const Pose& T_older_current) {
  // Of the upright frames, whose axes are those of odometry.
  const double yaw_rad = so3_log(T_older_current.rotation).norm();
  const Eigen::Vector3d shift_m =
      T_older_current.translation_m -
      (current.T_odom_sensor.translation_m - older.T_odom_sensor.translation_m);
  return yaw_rad < kMostYaw_rad && std::abs(shift_m.z()) < kFloorGate_m &&
         shift_m.head<2>().norm() < most_shift_m(older, current);
}

}  // namespace

std::span<const Place> places_around(std::span<const Place> places, std::size_t entry,
                                     std::size_t reach) {
  const auto neighbours = [&](std::size_t a, std::size_t b) {
    return places[a].segment == places[b].segment &&
           places[b].path_m - places[a].path_m <= kLongestGap_m;
  };
  std::size_t first = entry;
  while (first > 0 && entry - first < reach && neighbours(first - 1, first)) --first;
  std::size_t last = entry;
  while (last + 1 < places.size() && last - entry < reach && neighbours(last, last + 1)) ++last;
  return places.subspan(first, last - first + 1);
}

void DensitySearch::keep(std::span<const Place> places) {
  for (; kept_ + kMapReach < places.size(); ++kept_) {
    if (places[kept_].known) continue;
    if (!mapped_.empty() && kept_ < mapped_.back() + kMapEvery) continue;
    index_.add(make_density_map(places[kept_], places_around(places, kept_, kMapReach)));
    mapped_.push_back(kept_);
  }
}

void DensitySearch::renumber(std::span<const std::size_t> number_now) {
  for (std::size_t& entry : mapped_) entry = number_now[entry];
  kept_ = number_now[kept_];
}

// The entries that can be here, the nearest by odometry if they are many.
std::vector<std::size_t> DensitySearch::within_reach(std::span<const Place> places, std::size_t end,
                                                     float cell_m) const {
  const Place& current = places.back();
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t entry = 0; entry < mapped_.size() && mapped_[entry] < end; ++entry) {
    const Place& older = places[mapped_[entry]];
    if (older.segment != current.segment) continue;
    const double apart_m =
        (older.T_odom_sensor.translation_m - current.T_odom_sensor.translation_m).head<2>().norm();
    if (apart_m < most_shift_m(older, current) + static_cast<double>(kReach_cells * cell_m)) {
      near.emplace_back(apart_m, entry);
    }
  }
  std::ranges::sort(near);
  if (near.size() > kMostAsked) near.resize(kMostAsked);
  std::vector<std::size_t> entries;
  entries.reserve(near.size());
  for (const auto& [apart_m, entry] : near) entries.push_back(entry);
  return entries;
}

std::vector<DensitySearch::Proposal> DensitySearch::propose(std::span<const Place> places,
                                                            std::size_t end) {
  const std::size_t newest = places.size() - 1;
  const Place& current = places.back();
  std::vector<Proposal> proposals;
  asked_ = 0;
  if (within_reach(places, end, kCoarsest_m).empty()) return proposals;
  const DensityMap map = make_density_map(current, places_around(places, newest, 2 * kMapReach));
  const std::vector<std::size_t> near = within_reach(places, end, map.cell_m);
  asked_ = near.size();
  for (const DensityHit& hit : index_.query(map, near)) {
    const std::size_t entry = mapped_[hit.entry];
    const auto same = [&](const Proposal& better) {
      return std::max(better.entry, entry) - std::min(better.entry, entry) <= kSameReach;
    };
    if (!leaves_room(places[entry], current, hit.T_older_current)) continue;
    if (std::ranges::any_of(proposals, same)) continue;
    const Pose T_older_current =
        upright(places[entry]).inverse() * hit.T_older_current * upright(current);
    proposals.push_back({entry, T_older_current, hit.corners});
    if (proposals.size() == kMostProposals) break;
  }
  return proposals;
}

}  // namespace glint::slam
