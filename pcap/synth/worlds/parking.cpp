// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <cmath>
#include <numbers>

#include "pcap/synth/paint/decals.hpp"
#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/street_side.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr double kBayWidthM = 2.5;
constexpr double kBayDepthM = 5.0;
constexpr int kRows = 3;  // Double rows, nose to nose.
constexpr double kOuterAisleM = 7.0;
constexpr double kAisleM = 8.0;
constexpr double kEndM = 9.0;  // Free at either end of the rows.
constexpr double kIslandM = 1.8;
constexpr double kPaintM = 0.003;
constexpr double kOutskirtsM = 45.0;
constexpr double kVergeM = 5.0;  // Of grass round the lot.

struct Lot {
  int bays;
  double x;
  double y = 2.0 * kOuterAisleM + kRows * 2.0 * kBayDepthM + (kRows - 1) * kAisleM;

  explicit Lot(int bays_in_a_row)
      : bays(bays_in_a_row), x(2.0 * kEndM + bays_in_a_row * kBayWidthM) {}
  /// Where the noses meet.
  [[nodiscard]] static double row_y(int row) {
    return kOuterAisleM + kBayDepthM + row * (2.0 * kBayDepthM + kAisleM);
  }
};

void add_row(WorldBuilder& builder, const Lot& lot, double y, const StreetThings& things) {
  Random& random = builder.random();
  const Look paint{builder.material(Material::kRoadPaint), kSunlight};
  const double length_m = lot.bays * kBayWidthM;
  builder.add(level({kEndM, y - 0.05, kPaintM}, length_m, 0.1), paint);
  const double full = random.uniform(0.6, 0.85);
  for (int bay = 0; bay <= lot.bays; ++bay) {
    const double x = kEndM + bay * kBayWidthM;
    builder.add(level({x - 0.05, y - kBayDepthM, kPaintM}, 0.1, 2.0 * kBayDepthM), paint);
    if (bay == lot.bays) break;
    for (const double side : {-1.0, 1.0}) {
      if (!random.chance(full)) continue;
      const double heading_rad = -side * (random.chance(0.8) ? 0.5 : -0.5) * std::numbers::pi;
      const Eigen::Vector3d at_m(x + 0.5 * kBayWidthM + random.uniform(-0.15, 0.15),
                                 y + side * (0.5 * kBayDepthM + random.uniform(0.0, 0.3)), 0.0);
      builder.place_any(things.cars, at_m, heading_rad + random.uniform(-0.04, 0.04));
    }
  }
  for (double x = kEndM + random.uniform(4.0, 10.0); x < lot.x - kEndM;
       x += random.uniform(16.0, 26.0)) {
    builder.place_any(things.lamps, {x, y, 0.0}, (random.chance(0.5) ? 0.5 : -0.5) * M_PI);
  }
  for (const double x : {kEndM - 1.1, lot.x - kEndM + 1.1}) {
    const Look kerb{builder.material(Material::kPaving), kSunlight};
    add_box(builder.surfaces(), {x, y, 0.0}, {kIslandM, 1.7 * kBayDepthM, kKerbM}, 0.0, kerb);
    builder.place_any(random.chance(0.6) ? things.trees : things.signs,
                      {x, y + random.uniform(-2.0, 2.0), kKerbM},
                      random.uniform(0.0, 2.0 * std::numbers::pi));
  }
}

// Arrows that say which way round, manholes, on all aisles.
void paint_aisles(WorldBuilder& builder, const Lot& lot) {
  Random& random = builder.random();
  const Look arrow{road_arrow(0.9, 3.0, random), kSunlight};
  const auto put = [&](double x, double y, double heading_rad) {
    const Eigen::Vector3d v_axis(std::cos(heading_rad), std::sin(heading_rad), 0.0);
    const Eigen::Vector3d u_axis(v_axis.y(), -v_axis.x(), 0.0);
    builder.add(Rectangle{Eigen::Vector3d(x, y, kPaintM) - 0.45 * u_axis, u_axis, v_axis, 0.9, 3.0},
                arrow);
  };
  for (int aisle = 0; aisle <= kRows; ++aisle) {
    const double y = aisle == 0       ? 0.5 * kOuterAisleM
                     : aisle == kRows ? lot.y - 0.5 * kOuterAisleM
                                      : Lot::row_y(aisle) - kBayDepthM - 0.5 * kAisleM;
    for (double x = random.uniform(12.0, 20.0); x < lot.x - 12.0; x += random.uniform(14.0, 26.0)) {
      put(x, y + random.uniform(-1.0, 1.0), aisle % 2 == 0 ? 0.0 : std::numbers::pi);
    }
    for (double x = random.uniform(3.0, 20.0); x < lot.x - 4.0; x += random.uniform(10.0, 30.0)) {
      const Eigen::Vector3d at_m(x, y + random.uniform(-2.0, 1.5), kPaintM);
      builder.add(level(at_m, 0.7, 0.7), {manhole(0.7, random), kSunlight});
    }
  }
}

// Kerb, grass and trees round the lot, a wall or a fence behind, houses across the road.
void add_surroundings(WorldBuilder& builder, const Lot& lot, const StreetThings& things) {
  Random& random = builder.random();
  const Look grass{builder.material(Material::kGrass), kSunlight};
  const Look brick{builder.material(Material::kBrick, 1), kSunShade};
  const Look boards{builder.material(Material::kWood), kSunShade};
  const NextHouse next_house = [&](double room_m) {
    const double width_m = std::min(room_m, random.uniform(12.0, 24.0));
    return HouseChoice{house(builder, width_m, 12.0, 2 + random.below(3)), width_m, 12.0};
  };
  const int open_side = random.below(4);
  int index = 0;
  for (const StreetSide& side : sides_around({0.0, 0.0}, lot.x, lot.y)) {
    const Eigen::Vector3d middle_m = side.at(0.5 * side.length_m, 0.5 * kVergeM);
    add_box(builder.surfaces(), middle_m, {side.length_m, kVergeM, kKerbM}, side.heading_rad(),
            grass);
    for (double at_m = random.uniform(3.0, 8.0); at_m < side.length_m - 2.0;
         at_m += random.uniform(6.0, 18.0)) {
      builder.place_any(random.chance(0.75) ? things.trees : things.lamps,
                        side.at(at_m, random.uniform(1.5, 3.0), kKerbM),
                        side.heading_rad() - 0.5 * std::numbers::pi);
    }
    if (index++ != open_side) {
      const double height_m = random.uniform(0.6, 1.7);
      const Rectangle barrier =
          upright(side.at(0.0, kVergeM), side.at(side.length_m, kVergeM), height_m);
      builder.add(barrier, random.chance(0.5) ? brick : boards);
      if (height_m > 1.2) builder.hang_sign(barrier, {0.4 * barrier.width_m, 0.3, 1.2, 0.8}, 300.0);
      const StreetSide far{side.at(0.0, kVergeM + random.uniform(3.0, 9.0)).head<2>(), side.ahead,
                           side.length_m};
      build_row(builder, far, random.uniform(-8.0, 10.0), side.length_m, next_house);
    }
  }
}

}  // namespace

World make_parking(WorldBuilder& builder) {
  Random& random = builder.random();
  const Lot lot(23 + random.below(4));
  builder.add(level({-kOutskirtsM, -kOutskirtsM, 0.0}, lot.x + 2.0 * kOutskirtsM,
                    lot.y + 2.0 * kOutskirtsM),
              {builder.material(Material::kAsphalt), kSunlight});
  const StreetThings things = make_street_things(builder);
  for (int row = 0; row < kRows; ++row) add_row(builder, lot, Lot::row_y(row), things);
  paint_aisles(builder, lot);
  add_surroundings(builder, lot, things);

  Route route;
  route.closed = true;
  route.corner_radius_m = 4.0;
  const double x = random.uniform(3.8, 4.6);
  const double y = random.uniform(3.2, 3.8);
  route.points_m = {{x, y, 0},
                    {0.5 * lot.x, y, 0},
                    {lot.x - x, y, 0},
                    {lot.x - x, 0.5 * lot.y, 0},
                    {lot.x - x, lot.y - y, 0},
                    {0.5 * lot.x, lot.y - y, 0},
                    {x, lot.y - y, 0},
                    {x, 0.5 * lot.y, 0}};
  start_anywhere(route, random);
  return builder.finish(std::move(route), "wheeled");
}

}  // namespace glint::synth
