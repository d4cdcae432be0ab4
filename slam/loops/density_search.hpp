// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/loops/density_index.hpp"
#include "slam/loops/place.hpp"

namespace glint::slam {

/// Proposes places seen before by the shape of what stands around them: the local map of the last
/// keyframes, seen from above, is compared with those around earlier ones. Nothing need look alike
/// in the intensity image, so that few beams or bare walls do. Shape alone does not tell
/// two places of one make apart: only those are proposed that odometry, which is not far wrong
/// as a rule, leaves room for, on the same floor and in the same segment. Thread-compatible.
class DensitySearch {
 public:
  struct Proposal {
    std::size_t entry = 0;  ///< Of the places.
    Pose T_older_current;   ///< Of the sensors, good to a few cells.
    int corners = 0;        ///< That agree on it.
  };

  /// Maps that are compared with the current one at most: what a keyframe costs is bounded.
  static constexpr std::size_t kMostAsked = 150;

  /// Takes note of the places; those that have come since the last call are the last ones. Known
  /// ones are none that a map is kept of.
  void keep(std::span<const Place> places);
  /// Known places are taken out: `number_now` of each, that of the next one left for these.
  void renumber(std::span<const std::size_t> number_now);
  /// Older places, of those before `end`, that the last one may be at, the best first; at most a
  /// few, none next to a better one.
  std::vector<Proposal> propose(std::span<const Place> places, std::size_t end);
  /// How many maps the last propose() compared.
  [[nodiscard]] std::size_t asked() const { return asked_; }

 private:
  [[nodiscard]] std::vector<std::size_t> within_reach(std::span<const Place> places,
                                                      std::size_t end, float cell_m) const;

  DensityIndex index_;
  std::vector<std::size_t> mapped_;  ///< The place of each of its entries.
  std::size_t kept_ = 0;             ///< Places before this one were looked at.
  std::size_t asked_ = 0;
};

/// The places that stand for the surroundings of places[entry]: those of its segment up to `reach`
/// before and after it.
std::span<const Place> places_around(std::span<const Place> places, std::size_t entry,
                                     std::size_t reach);

}  // namespace glint::slam
