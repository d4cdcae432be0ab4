// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/odometry_estimate.hpp"

namespace glint::slam {

std::string_view to_string(TrackingState state) {
  switch (state) {
    case TrackingState::kInit:
      return "INIT";
    case TrackingState::kTracking:
      return "TRACKING";
    case TrackingState::kDegraded:
      return "DEGRADED";
    case TrackingState::kLost:
      return "LOST";
    case TrackingState::kLocalizing:
      return "LOCALIZING";
    case TrackingState::kPaused:
      return "PAUSED";
  }
  return "UNKNOWN";
}

std::optional<TrackingState> tracking_state_from(std::string_view name) {
  using enum TrackingState;
  for (const auto state : {kInit, kTracking, kDegraded, kLost, kLocalizing, kPaused}) {
    if (name == to_string(state)) return state;
  }
  return std::nullopt;
}

}  // namespace glint::slam
