// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <functional>
#include <vector>

#include "driver/core/pose.hpp"

namespace glint::synth {

/// A place on a path: position of the carrier on the ground and the way it faces.
struct PathPoint {
  double x_m = 0;
  double y_m = 0;
  double heading_rad = 0;
};

/// A sequence of smooth pieces of a carrier's motion: rests, walks along a line or curve, turns on
/// the spot. Speed rises and falls with continuous acceleration. After the last piece it starts
/// over.
class Itinerary {
 public:
  /// Stands for a time.
  void rest(double seconds);
  /// Follows `path` (by arc length, 0 to length_m), from standstill to standstill.
  void follow(std::function<PathPoint(double)> path, double length_m, double speed_mps);
  /// Follows a closed `path` for ever, from standstill. The last piece.
  void circle(std::function<PathPoint(double)> path, double speed_mps);
  /// Turns on the spot by an angle within a time.
  void turn(double angle_rad, double seconds);

  struct State {
    PathPoint point;
    double speed_mps = 0;
  };
  [[nodiscard]] State at(double t_s) const;

 private:
  struct Piece {
    double start_s = 0;
    double duration_s = 0;  ///< Infinite for circle().
    std::function<State(double)> at;
  };
  void add(double duration_s, std::function<State(double)> at);
  std::vector<Piece> pieces_;
  double total_s_ = 0;
};

/// A sensor carried by a walking person: the bob, sway and nod of a gait grow with the speed.
/// The pose is a smooth function of time. Immutable; thread-safe.
class WalkingMotion {
 public:
  WalkingMotion(Itinerary itinerary, double sensor_height_m, std::uint64_t seed);
  /// T_world_sensor at `t_s` seconds after the start.
  [[nodiscard]] Pose at(double t_s) const;

 private:
  Itinerary itinerary_;
  double sensor_height_m_;
  double step_hz_;
  double phase_rad_;
};

}  // namespace glint::synth
