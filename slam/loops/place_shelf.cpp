// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/loops/place_shelf.hpp"

#include <algorithm>
#include <utility>

namespace glint::slam {

void PlaceShelf::add(Place place) {
  places_.push_back(std::move(place));
  unread_.push_back(false);
}

void PlaceShelf::add_unread(std::uint64_t keyframe, std::uint32_t segment,
                            const Pose& T_map_sensor) {
  Place place;
  place.id = keyframe;
  place.segment = segment;
  place.T_odom_sensor = T_map_sensor;
  places_.push_back(std::move(place));
  unread_.push_back(true);
}

Place PlaceShelf::at(std::size_t entry) {
  Place& place = places_[entry];
  if (!unread_[entry]) return place;
  if (auto whole = read_(place.id)) {
    place.descriptors = std::move(whole->descriptors);
    place.keypoints_m = std::move(whole->keypoints_m);
    place.points_m = std::move(whole->points_m);
    place.voxel_m = whole->voxel_m;
  } else {
    place.voxel_m = PlaceOptions{}.finest_voxel_m;
  }
  unread_[entry] = false;
  lent_.push_back(entry);
  if (lent_.size() > kMostRead) {
    Place& oldest = places_[lent_.front()];
    oldest.descriptors = {};
    oldest.keypoints_m = {};
    oldest.points_m = {};
    unread_[lent_.front()] = true;
    lent_.pop_front();
  }
  return places_[entry];
}

std::vector<Place> PlaceShelf::around(std::size_t entry, std::size_t reach) {
  const std::size_t last = std::min(places_.size() - 1, entry + reach);
  std::vector<Place> places;
  places.reserve(2 * reach + 1);
  for (std::size_t i = entry - std::min(entry, reach); i <= last; ++i) {
    if (places_[i].segment == places_[entry].segment) places.push_back(at(i));
  }
  return places;
}

std::vector<Place> PlaceShelf::nearest(const Eigen::Vector3d& at_m, std::size_t most,
                                       double reach_m) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const double away_m2 = (places_[i].T_odom_sensor.translation_m - at_m).squaredNorm();
    if (away_m2 <= reach_m * reach_m) order.emplace_back(away_m2, i);
  }
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(most, order.size()));
  std::partial_sort(order.begin(), end, order.end());
  std::vector<Place> places;
  places.reserve(most);
  for (auto next = order.begin(); next != end; ++next) places.push_back(at(next->second));
  return places;
}

}  // namespace glint::slam
