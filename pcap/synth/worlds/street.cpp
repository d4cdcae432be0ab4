// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <algorithm>
#include <cmath>

#include "pcap/synth/paint/decals.hpp"
#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/street_side.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr double kLaneM = 3.2;
constexpr double kRoadM = 2.0 * (kParkingLaneM + kLaneM);
// From the block's kerb: the lane next to it, the line between the lanes, the lane that the route
// keeps to.
constexpr double kOtherLaneM = kParkingLaneM + 0.5 * kLaneM;
constexpr double kMiddleM = kParkingLaneM + kLaneM;
constexpr double kOwnLaneM = kMiddleM + 0.5 * kLaneM;
constexpr double kHouseDepthM = 10.0;
constexpr double kOutskirtsM = 25.0;  // Beyond the outer kerb the ground goes on so far.

// Half sizes of the block with its pavement; its middle is the origin.
struct Block {
  double x;
  double y;

  [[nodiscard]] Eigen::Vector2d corner_m(double out_m) const { return {-x - out_m, -y - out_m}; }
};

NextHouse new_houses(WorldBuilder& builder) {
  return [&builder](double room_m) {
    Random& random = builder.random();
    const double width_m = std::min(room_m, random.uniform(9.0, 16.0));
    return HouseChoice{house(builder, width_m, kHouseDepthM, 2 + random.below(4)), width_m,
                       kHouseDepthM};
  };
}

void add_ground(WorldBuilder& builder, const Block& block) {
  const Look asphalt{builder.material(Material::kAsphalt), kSunlight};
  const Look paving{builder.material(Material::kPaving), kSunlight};
  const double x = block.x + kRoadM;
  const double y = block.y + kRoadM;
  builder.add(level({-x, -y, 0.0}, 2.0 * x, 2.0 * y), asphalt);
  Surfaces& surfaces = builder.surfaces();
  add_box(surfaces, {0, 0, 0}, {2.0 * block.x, 2.0 * block.y, kKerbM}, 0.0, paving);
  for (const double side : {-1.0, 1.0}) {
    add_box(surfaces, {0, side * (y + 0.5 * kOutskirtsM), 0},
            {2.0 * (x + kOutskirtsM), kOutskirtsM, kKerbM}, 0.0, paving);
    add_box(surfaces, {side * (x + 0.5 * kOutskirtsM), 0, 0}, {kOutskirtsM, 2.0 * y, kKerbM}, 0.0,
            paving);
  }
}

// Lines between the lanes, beside the parking lanes, crossings with bars; covers of manholes.
void paint_road(WorldBuilder& builder, const StreetSide& side) {
  Random& random = builder.random();
  const auto line = [&](double right_m, double width_m, bool dashed) {
    paint_line(builder, side.at(4.0, -right_m).head<2>(),
               side.at(side.length_m - 4.0, -right_m).head<2>(), width_m, dashed);
  };
  line(kParkingLaneM, 0.1, false);
  line(kMiddleM, 0.12, true);
  line(kRoadM - kParkingLaneM, 0.1, false);
  const double crossing_m = random.uniform(0.0, 1.5);
  for (double right_m = 0.6; right_m < kRoadM - 0.6; right_m += 1.0) {
    paint_line(builder, side.at(crossing_m, -right_m).head<2>(),
               side.at(crossing_m + 3.0, -right_m).head<2>(), 0.5, false);
  }
  for (double at_m = random.uniform(5.0, 15.0); at_m < side.length_m - 5.0;
       at_m += random.uniform(8.0, 25.0)) {
    const Eigen::Vector3d corner_m = side.at(at_m, -random.uniform(3.0, kRoadM - 3.0), 0.003);
    builder.add(level(corner_m, 0.7, 0.7), {manhole(0.7, random), kSunlight});
  }
}

// Cars that come towards the route in the other lane, all equally fast; people on pavements.
void add_traffic(WorldBuilder& builder, const Block& block,
                 const std::vector<StreetSide>& pavements, const StreetThings& things) {
  Random& random = builder.random();
  const RoundWay way({0, 0, 0}, 2.0 * (block.x + kOtherLaneM), 2.0 * (block.y + kOtherLaneM), 5.0,
                     0.0, true);
  const auto as_many = [&](int usual) {
    return static_cast<int>(std::lround(usual * builder.traffic()));
  };
  // Bumper to bumper at most.
  const int cars = std::min(as_many(4 + random.below(5)), static_cast<int>(way.length_m() / 7.0));
  const double apart_m = way.length_m() / std::max(cars, 1);
  const double jitter = std::min(0.3, 0.5 * (1.0 - 5.0 / apart_m));
  const double speed_mps = random.uniform(5.0, 8.0);
  for (int i = 0; i < cars; ++i) {
    add_driver(builder, things, way, apart_m * (i + random.uniform(-jitter, jitter)), speed_mps);
  }
  const int people = as_many(6 + random.below(5));
  for (int i = 0; i < people; ++i) {
    add_walker(builder, pavements[static_cast<std::size_t>(i) % pavements.size()], things);
  }
}

}  // namespace

World make_street(WorldBuilder& builder) {
  Random& random = builder.random();
  const double x = random.uniform(38.0, 45.0);
  const Block block{x, 76.0 - x + random.uniform(-2.0, 2.0)};
  add_ground(builder, block);
  const StreetThings things = make_street_things(builder);
  const NextHouse next_house = new_houses(builder);

  std::vector<StreetSide> pavements =
      sides_of_block(block.corner_m(0.0), 2.0 * block.x, 2.0 * block.y);
  for (const StreetSide& side : pavements) {
    // Each row begins at its corner and leaves the next one to the next row.
    build_row(builder, side, kPavementM, side.length_m - kPavementM - kHouseDepthM, next_house);
    paint_road(builder, side);
  }
  for (const StreetSide& side :
       sides_around(block.corner_m(kRoadM), 2.0 * (block.x + kRoadM), 2.0 * (block.y + kRoadM))) {
    build_row(builder, side, -kPavementM, side.length_m + kPavementM + kHouseDepthM, next_house);
    pavements.push_back(side);
  }
  for (const StreetSide& side : pavements) furnish(builder, side, things);
  add_traffic(builder, block, pavements, things);

  Route route;
  route.closed = true;
  route.corner_radius_m = 6.0;
  const double lane_x = block.x + kOwnLaneM;
  const double lane_y = block.y + kOwnLaneM;
  // Anticlockwise, in the right-hand lane; half-way points to begin in a street.
  route.points_m = {{0, -lane_y, 0}, {lane_x, -lane_y, 0}, {lane_x, 0, 0},  {lane_x, lane_y, 0},
                    {0, lane_y, 0},  {-lane_x, lane_y, 0}, {-lane_x, 0, 0}, {-lane_x, -lane_y, 0}};
  std::rotate(route.points_m.begin(), route.points_m.begin() + std::ptrdiff_t{2} * random.below(4),
              route.points_m.end());
  return builder.finish(std::move(route), "wheeled");
}

}  // namespace glint::synth
