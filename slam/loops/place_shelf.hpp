// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "slam/loops/place.hpp"

namespace glint::slam {

/// The places of a map, in the order of its keyframes; their odometry is the map. What a place
/// shows may stay in a file until somebody looks at it: kMostRead of those that were looked at are
/// in memory. Thread-compatible.
class PlaceShelf {
 public:
  /// Reads the place of a keyframe. Null where it cannot be read: then it shows nothing.
  using Read = std::function<std::optional<Place>(std::uint64_t keyframe)>;

  /// Places from the file in memory at most: some 20 MB.
  static constexpr std::size_t kMostRead = 400;

  void add(Place place);
  /// From here on places may be added that `read` is asked for. To be called once.
  void read_with(Read read) { read_ = std::move(read); }
  void add_unread(std::uint64_t keyframe, std::uint32_t segment, const Pose& T_map_sensor);

  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const Pose& pose(std::size_t entry) const { return places_[entry].T_odom_sensor; }
  /// The place with all that it shows; copies share that.
  Place at(std::size_t entry);
  /// Those of its segment up to `reach` before and after it, itself among them, in order.
  std::vector<Place> around(std::size_t entry, std::size_t reach);
  /// The `most` nearest to a point of the map, within `reach_m` of it, the nearest first.
  std::vector<Place> nearest(const Eigen::Vector3d& at_m, std::size_t most, double reach_m);

 private:
  std::vector<Place> places_;
  std::vector<bool> unread_;      ///< Of each.
  std::deque<std::size_t> lent_;  ///< Entries that were read, the oldest first.
  Read read_;
};

}  // namespace glint::slam
