// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>

#include "pcap/synth/worlds/round_way.hpp"
#include "pcap/synth/worlds/things.hpp"

namespace glint::synth {

inline constexpr double kKerbM = 0.12;        ///< Pavements are so much higher than the road.
inline constexpr double kPavementM = 2.5;     ///< Wide, from kerb to house fronts.
inline constexpr double kParkingLaneM = 2.2;  ///< Wide, along each kerb.

/// One side of a street, seen by who walks along its kerb: the pavement and the houses on the left,
/// the road on the right. Traffic drives on the right.
struct StreetSide {
  Eigen::Vector2d from_m;
  Eigen::Vector2d ahead;  ///< Unit.
  double length_m;

  /// So far along it and to the left of the kerb.
  [[nodiscard]] Eigen::Vector3d at(double along_m, double left_m, double z_m = 0.0) const;
  [[nodiscard]] double heading_rad() const;
};

/// The four sides along the kerb round a block, its houses on the left.
std::vector<StreetSide> sides_of_block(const Eigen::Vector2d& corner_m, double x_m, double y_m);
/// The four sides opposite, along the kerb round everything from `corner_m` on: houses outside.
std::vector<StreetSide> sides_around(const Eigen::Vector2d& corner_m, double x_m, double y_m);

struct HouseChoice {
  BodyPtr body;
  double width_m;
  double depth_m;
};
/// Chooses a house that is at most so wide.
using NextHouse = std::function<HouseChoice(double room_m)>;

/// What stands in streets, a few of each kind to choose from.
struct StreetThings {
  Variants cars;
  Variants trees;
  Variants lamps;
  Variants signs;
  Variants people;
};
StreetThings make_street_things(WorldBuilder& builder);

/// Houses in a row between two places along the side, now and then a gap with a garden wall.
void build_row(WorldBuilder& builder, const StreetSide& side, double begin_m, double end_m,
               const NextHouse& next_house);
/// Lamps, trees and signs along the kerb; parked cars with gaps. Nothing near the corners.
void furnish(WorldBuilder& builder, const StreetSide& side, const StreetThings& things);
/// Somebody who walks up and down the pavement.
void add_walker(WorldBuilder& builder, const StreetSide& side, const StreetThings& things);
/// A car that drives on and on, `start_m` of its way ahead at first.
void add_driver(WorldBuilder& builder, const StreetThings& things, const RoundWay& way,
                double start_m, double speed_mps);
/// A line on the road, dashed or not, from one place to another.
void paint_line(WorldBuilder& builder, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                double width_m, bool dashed);

}  // namespace glint::synth
