// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// How a back end looks for the sensor's place anew, in the map that it has.
#include <algorithm>
#include <utility>

#include "driver/core/error.hpp"
#include "slam/backend.hpp"
#include "slam/loops/vocabulary.hpp"

namespace glint::slam {

MapSearch Backend::search() const {
  if (localizer_) return correction_.placed ? MapSearch::kNone : MapSearch::kMapOnlyRead;
  if (!search_) return MapSearch::kNone;
  return search_->session.empty() ? MapSearch::kOwnMap : MapSearch::kEarlierMap;
}

bool Backend::guess_dropped() const {
  if (localizer_) return localizer_->guess_dropped();
  return search_ && search_->relocalizer.guess_dropped();
}

bool Backend::search_anew(const std::optional<PlaceGuess>& guess) {
  if (localizer_) {
    localizer_->search_anew(guess, correction_);
    publish();
    return true;
  }
  if (!search_) {
    auto relocalizer = knowing_own_map();
    if (!relocalizer) return false;
    search_.emplace(PlaceSearch{{}, std::move(*relocalizer), {}, {}, {}});
  }
  search_->begin.reset();
  search_->found.reset();
  search_->relocalizer.begin_anew();
  if (guess) search_->relocalizer.begin_near(*guess);
  correction_.placed = false;
  correction_.confidence = 0.0;
  ++correction_.epoch;
  publish();
  return true;
}

// Keyframes are in the session only: in memory they would take much room for what is rarely asked.
std::optional<Relocalizer> Backend::knowing_own_map() {
  if (!store_ || graph_.nodes().empty() || !store_->commit()) return std::nullopt;
  try {
    return knowing_places(
        std::make_shared<const SessionReader>(session_file_, SessionCheck::kVersion), {});
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool Backend::begins_segment(const Keyframe& keyframe) const {
  return !localizer_ && !search_ && !graph_.nodes().empty() &&
         odometry_segment(graph_.nodes().back().segment) != keyframe.estimate.segment;
}

void Backend::go_on_unfound() {
  if (search() != MapSearch::kOwnMap) return;
  const PlaceSearch search = std::move(*search_);
  search_.reset();
  correction_.placed = true;
  correction_.confidence = 1.0;
  ++correction_.epoch;
  for (const Keyframe& keyframe : search.waiting) take(keyframe);
  store_changes();
  publish();
}

// The map may have had the sensor elsewhere: what was held back is no longer linked to it by
// odometry, only by what it saw of it.
void Backend::set_apart(std::vector<Keyframe>& waiting) {
  const std::uint32_t segment = waiting.front().estimate.segment;
  if (graph_.nodes().back().segment != segment) return;
  set_apart_.push_back(segment + 1);
  for (Keyframe& keyframe : waiting) ++keyframe.estimate.segment;
}

std::uint32_t Backend::odometry_segment(std::uint32_t map_segment) const {
  const auto apart = std::ranges::count_if(
      set_apart_, [&](std::uint32_t segment) { return segment <= map_segment; });
  return map_segment - first_segment_ - static_cast<std::uint32_t>(apart);
}

}  // namespace glint::slam
