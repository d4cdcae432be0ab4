// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "pcap/synth/motion/route.hpp"

namespace glint::synth {

/// A place on a way.
struct WayPoint {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double heading_rad = 0.0;  ///< Direction of travel about z, without jumps of 2 pi.
  double slope = 0.0;        ///< Climb per way.
};

/// A route as one travels it, by the length of way: legs joined by arcs. It leads back to its start
/// (an open route there and back) and goes on for ever. Immutable.
class Way {
 public:
  /// An arc or, without turn, a straight; one without length is a turn on the spot.
  struct Piece {
    double start_m;   ///< Way before it.
    double length_m;  ///< Along the slope.
    double turn_rad;  ///< To the left.
    Eigen::Vector2d from_m;
    Eigen::Vector2d to_m;
    double heading_rad;      ///< At its start.
    double turning_rad;      ///< Turns before it, left and right alike; not those on the spot.
    double height_m;         ///< At its start.
    double slope;            ///< Of the route there.
    double height_integral;  ///< Of the height over the way before it, m^2.
  };

  /// `base_m`: what travels stands on so much of the ground, which levels out kinks in its height.
  /// @throws OptionError if the route has no two points apart from each other.
  Way(const Route& route, double base_m);

  [[nodiscard]] WayPoint at(double way_m) const;
  /// How much it has turned up to there, left and right alike, not counting turns on the spot.
  [[nodiscard]] double turning_rad(double way_m) const;

  // Once round.
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double turn_rad() const { return turn_rad_; }  ///< Net; a multiple of 2 pi.
  [[nodiscard]] std::span<const Piece> pieces() const { return pieces_; }

 private:
  struct Place;
  [[nodiscard]] Place find(double way_m) const;
  [[nodiscard]] double height_m(double way_m) const;
  [[nodiscard]] double height_integral(double way_m) const;

  const double base_m_;
  std::vector<Piece> pieces_;
  double length_m_ = 0.0;
  double turn_rad_ = 0.0;
};

}  // namespace glint::synth
