// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/worlds/climbing.hpp"

#include <algorithm>
#include <cmath>

namespace glint::synth {
namespace {

const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();
// How far a flight's underside is below its steps' inner edges.
constexpr double kSlabM = 0.15;

Eigen::Vector3d left_of(const Eigen::Vector3d& ahead) { return kZ.cross(ahead).normalized(); }

}  // namespace

void add_flight(Surfaces& surfaces, const Flight& flight, const Look& tread, const Look& riser) {
  const Eigen::Vector3d left = left_of(flight.ahead);
  const Eigen::Vector3d half = 0.5 * flight.width_m * left;
  for (int i = 0; i < flight.risers; ++i) {
    const Eigen::Vector3d at_m = flight.foot_m + i * kTreadM * flight.ahead + i * kRiseM * kZ;
    add(surfaces, upright(at_m + half, at_m - half, kRiseM), riser);
    if (i + 1 == flight.risers) break;
    add(surfaces, Rectangle{at_m - half + kRiseM * kZ, flight.ahead, left, kTreadM, flight.width_m},
        tread);
    const Eigen::Vector3d next_m = at_m + kTreadM * flight.ahead;
    // A stringer does not reach below the level that the flight stands on.
    const Eigen::Vector3d down_m = (i > 0 ? kSlabM : 0.0) * kZ;
    add(surfaces, upright(at_m - half - down_m, next_m - half - down_m, kRiseM + down_m.z()),
        riser);
    add(surfaces, upright(next_m + half - down_m, at_m + half - down_m, kRiseM + down_m.z()),
        riser);
  }
  const Eigen::Vector3d low_m = flight.foot_m + kTreadM * flight.ahead + (kRiseM - kSlabM) * kZ;
  const Eigen::Vector3d high_m = flight.end_m() - (kRiseM + kSlabM) * kZ;
  add(surfaces, between(low_m - half, low_m + half, high_m - half), riser);
}

void add_ramp(Surfaces& surfaces, const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m,
              double width_m, const Look& top, const Look& side) {
  Eigen::Vector3d ahead = high_m - low_m;
  ahead.z() = 0.0;
  const Eigen::Vector3d half = 0.5 * width_m * left_of(ahead);
  add(surfaces, between(low_m - half, high_m - half, low_m + half), top);
  const Eigen::Vector3d below_high_m = low_m + ahead;
  add_triangle(surfaces, low_m - half, below_high_m - half, high_m - half, side);
  add_triangle(surfaces, below_high_m + half, low_m + half, high_m + half, side);
  if (low_m.z() <= 0.0) return;
  const Eigen::Vector3d down_m = low_m.z() * kZ;
  add(surfaces, upright(low_m - half - down_m, below_high_m - half - down_m, low_m.z()), side);
  add(surfaces, upright(below_high_m + half - down_m, low_m + half - down_m, low_m.z()), side);
}

void add_railing(Surfaces& surfaces, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                 const Look& look) {
  constexpr double kHeightM = 1.0;
  constexpr double kRailM = 0.06;
  constexpr double kPostsApartM = 1.5;
  const Eigen::Vector3d way_m = to_m - from_m;
  const Eigen::Vector3d u_axis = way_m.normalized();
  const Eigen::Vector3d v_axis = u_axis.cross(left_of(way_m)).normalized();
  for (const double height_m : {0.5 * kHeightM, kHeightM - kRailM}) {
    add(surfaces, Rectangle{from_m + height_m * kZ, u_axis, v_axis, way_m.norm(), kRailM}, look);
  }
  const int gaps = std::max(1, static_cast<int>(std::lround(way_m.norm() / kPostsApartM)));
  for (int i = 0; i <= gaps; ++i) {
    add(surfaces, Cylinder{from_m + way_m * (static_cast<double>(i) / gaps), 0.025, kHeightM},
        look);
  }
}

}  // namespace glint::synth
