// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <algorithm>

#include "pcap/synth/paint/decoration.hpp"
#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr double kWidthM = 2.4;
// Between pictures that belong to one place only.
constexpr double kPicturesApartM = 7.0;

// What all four corridors show. The shorter ones show the first part of it.
struct CommonLooks {
  Look outer;
  Look inner;
  Look floor;
  Look ceiling;
  Look cabinet;
  double cabinet_at_m;
};

// One of the four: from an outer corner `start_m` on, with the building's middle on the left.
void add_corridor(WorldBuilder& builder, const Eigen::Vector3d& start_m,
                  const Eigen::Vector3d& ahead, double length_m, double height_m,
                  const CommonLooks& looks) {
  const Eigen::Vector3d inwards = Eigen::Vector3d::UnitZ().cross(ahead);
  const Eigen::Vector3d inner_m = start_m + kWidthM * inwards;
  const Eigen::Vector3d end_m = start_m + (length_m + kWidthM) * ahead;
  const Rectangle outer = upright(end_m, start_m, height_m);
  const Rectangle inner = upright(inner_m + kWidthM * ahead, inner_m + length_m * ahead, height_m);
  builder.add(outer, looks.outer);
  builder.add(inner, looks.inner);
  // Up to where the next corridor begins.
  builder.add(Rectangle{start_m, ahead, inwards, length_m, kWidthM}, looks.floor);
  builder.add(
      Rectangle{inner_m + height_m * Eigen::Vector3d::UnitZ(), ahead, -inwards, length_m, kWidthM},
      looks.ceiling);
  constexpr double kDepthM = 0.36;
  add_box(builder.surfaces(), inner_m + looks.cabinet_at_m * ahead - 0.5 * kDepthM * inwards,
          {0.9, kDepthM, 1.8}, std::atan2(ahead.y(), ahead.x()), looks.cabinet);
  builder.hang_pictures(outer, kWidthM, length_m, kPicturesApartM, kLampLight);
  builder.hang_pictures(inner, 0.5, length_m - kWidthM, kPicturesApartM, kLampLight);
}

}  // namespace

World make_building(WorldBuilder& builder) {
  Random& random = builder.random();
  const double x = random.uniform(57.0, 63.0);
  const double y = random.uniform(38.0, 42.0);
  const double height_m = random.uniform(2.6, 2.8);
  const CommonLooks looks{{office_wall(x + kWidthM, height_m, random), kLampLight},
                          {office_wall(x - kWidthM, height_m, random), kLampLight},
                          {office_floor(x, kWidthM, random), kLampLight},
                          {panel_ceiling(x, kWidthM, random), kLampShade},
                          {furniture_side(0.9, 1.8, random), kLampShade},
                          random.uniform(8.0, 30.0)};
  // The plan is that of the corridors' middle lines; outside are its outer corners.
  const double out = 0.5 * kWidthM;
  const Eigen::Vector3d ahead_x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d ahead_y = Eigen::Vector3d::UnitY();
  add_corridor(builder, {-out, -out, 0.0}, ahead_x, x, height_m, looks);
  add_corridor(builder, {x + out, -out, 0.0}, ahead_y, y, height_m, looks);
  add_corridor(builder, {x + out, y + out, 0.0}, -ahead_x, x, height_m, looks);
  add_corridor(builder, {-out, y + out, 0.0}, -ahead_y, y, height_m, looks);

  Route route;
  route.closed = true;
  route.corner_radius_m = 0.9;
  route.clear_height_m = height_m;
  const auto stray = [&](double at_m) { return at_m + random.uniform(-0.15, 0.15); };
  // Half-way points, so that the walk can begin in a corridor.
  for (const Eigen::Vector2d& share :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.5, 0), Eigen::Vector2d(1, 0),
        Eigen::Vector2d(1, 0.5), Eigen::Vector2d(1, 1), Eigen::Vector2d(0.5, 1),
        Eigen::Vector2d(0, 1), Eigen::Vector2d(0, 0.5)}) {
    const double at_x = stray(share.x() * x);
    route.points_m.emplace_back(at_x, stray(share.y() * y), 0.0);
  }
  start_anywhere(route, random);
  return builder.finish(std::move(route), "walking");
}

}  // namespace glint::synth
