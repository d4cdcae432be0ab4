// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "pcap/synth/worlds/shapes.hpp"

// What leads from one level to another.
namespace glint::synth {

inline constexpr double kRiseM = 0.17;
inline constexpr double kTreadM = 0.29;

/// A straight flight of steps. The last riser leads onto the upper level, so there is one tread
/// less than risers.
struct Flight {
  Eigen::Vector3d foot_m;  ///< Middle of the first riser's lower edge.
  Eigen::Vector3d ahead;   ///< Unit, level.
  double width_m;
  int risers;

  [[nodiscard]] double height_m() const { return risers * kRiseM; }
  [[nodiscard]] double length_m() const { return (risers - 1) * kTreadM; }
  /// Where one begins to climb, on the lower level, and where one has arrived, on the upper:
  /// between the two one goes straight over the steps' edges.
  [[nodiscard]] Eigen::Vector3d begin_m() const { return foot_m - kTreadM * ahead; }
  [[nodiscard]] Eigen::Vector3d end_m() const {
    return foot_m + length_m() * ahead + height_m() * Eigen::Vector3d::UnitZ();
  }
};

/// Treads, risers, stringers and the flight's underside.
void add_flight(Surfaces& surfaces, const Flight& flight, const Look& tread, const Look& riser);
/// A slope between the middles of its lower and its upper edge, solid down to z = 0.
void add_ramp(Surfaces& surfaces, const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m,
              double width_m, const Look& top, const Look& side);
/// Posts, a handrail and a rail at half height, from one place to another on a level or a slope.
void add_railing(Surfaces& surfaces, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                 const Look& look);

}  // namespace glint::synth
