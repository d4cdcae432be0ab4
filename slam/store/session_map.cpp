// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/store/session_map.hpp"

#include <charconv>
#include <limits>
#include <string>

#include "slam/moving_points.hpp"

namespace glint::slam {
namespace {

// What sessions that do not say were made with: the middle of what back ends choose.
constexpr double kUsualVoxel_m = 0.1;
constexpr double kFinestVoxel_m = 0.01;
constexpr double kCoarsestVoxel_m = 100.0;

double number_in(const std::string& text, double otherwise) {
  double value = otherwise;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

double session_voxel_m(const SessionReader& session) {
  const double voxel_m = number_in(session.meta("map_voxel_m"), kUsualVoxel_m);
  return voxel_m >= kFinestVoxel_m && voxel_m <= kCoarsestVoxel_m ? voxel_m : kUsualVoxel_m;
}

MovingInSession moving_in_session(const SessionReader& session) {
  const std::string said = session.meta("moving_objects");
  if (said == "removed") return MovingInSession::kRemoved;
  return said == "kept" ? MovingInSession::kWanted : MovingInSession::kToBeLeftOut;
}

std::shared_ptr<const MapSnapshot> session_map(const SessionReader& session, double voxel_m) {
  const bool as_stored = moving_in_session(session) != MovingInSession::kToBeLeftOut;
  // Memory is the limit here: the map is not for a daemon that must go on.
  VoxelMap map(voxel_m > 0.0 ? voxel_m : session_voxel_m(session),
               std::numeric_limits<std::size_t>::max());
  MovingPoints moving;
  std::size_t keyframes = 0;
  session.for_each_keyframe([&](SessionKeyframe&& of_session) {
    const Keyframe& keyframe = of_session.keyframe;
    map.insert(of_session.T_map_sensor, as_stored ? keyframe.points : moving.standing(keyframe));
    ++keyframes;
  });
  auto snapshot = map.snapshot();
  snapshot->keyframe_count = keyframes;
  return snapshot;
}

}  // namespace glint::slam
