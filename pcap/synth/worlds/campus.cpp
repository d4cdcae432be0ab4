// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <algorithm>
#include <array>
#include <cmath>

#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/street_side.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr int kBlocks = 6;  // Each way; between and around them are streets.
constexpr double kLaneM = 3.5;
constexpr double kRoadM = 2.0 * (kLaneM + kParkingLaneM);
constexpr double kHouseDepthM = 11.0;
constexpr double kLeastWayM = 5200.0;
constexpr double kMostWayM = 7000.0;
constexpr int kMovingLoops = 8;
// Between the middle of the route's lane and that of another car: the lanes are farther apart.
constexpr double kClearOfRouteM = 3.0;

// Crossing (i, j) is at (i * pitch_x, j * pitch_y).
struct Grid {
  double block_x;  ///< With its pavements.
  double block_y;

  [[nodiscard]] Eigen::Vector2d crossing_m(const Eigen::Vector2i& at) const {
    return {at.x() * (block_x + kRoadM), at.y() * (block_y + kRoadM)};
  }
  [[nodiscard]] Eigen::Vector2d block_corner_m(int i, int j) const {
    return crossing_m({i, j}) + Eigen::Vector2d::Constant(0.5 * kRoadM);
  }
  [[nodiscard]] double street_m(const Eigen::Vector2i& ahead) const {
    return ahead.x() != 0 ? block_x + kRoadM : block_y + kRoadM;
  }
};

const std::array<Eigen::Vector2i, 4> kDirections = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

// A drive from crossing to crossing that never turns back and ends where it began.
struct Drive {
  std::vector<Eigen::Vector2i> crossings;
  std::vector<int> directions;  ///< Out of each crossing, of kDirections.
  double length_m = 0.0;
};

bool inside(const Eigen::Vector2i& crossing) {
  return crossing.minCoeff() >= 0 && crossing.maxCoeff() <= kBlocks;
}

// The next direction: any but back and out of the grid; once the drive is long enough, one that
// leads home.
int choose_direction(const Eigen::Vector2i& at, const Eigen::Vector2i& home, int from,
                     bool homewards, Random& random) {
  std::vector<int> possible;
  std::vector<int> leading_home;
  for (int turn : {0, 0, 1, 3}) {  // straight on twice as often
    const int direction = (from + turn) % 4;
    const Eigen::Vector2i next = at + kDirections[static_cast<std::size_t>(direction)];
    if (!inside(next)) continue;
    possible.push_back(direction);
    if ((next - home).lpNorm<1>() < (at - home).lpNorm<1>()) leading_home.push_back(direction);
  }
  const auto& choice = homewards && !leading_home.empty() ? leading_home : possible;
  return choice[static_cast<std::size_t>(random.below(static_cast<int>(choice.size())))];
}

// Empty if it does not find home in time.
Drive try_drive(const Grid& grid, Random& random) {
  const Eigen::Vector2i home(kBlocks / 2, kBlocks / 2);
  Drive drive;
  Eigen::Vector2i at = home;
  int direction = random.below(4);
  while (drive.length_m < kMostWayM) {
    drive.crossings.push_back(at);
    drive.directions.push_back(direction);
    const Eigen::Vector2i ahead = kDirections[static_cast<std::size_t>(direction)];
    at += ahead;
    drive.length_m += grid.street_m(ahead);
    const bool homewards = drive.length_m > kLeastWayM - 300.0;
    const bool turns_back = (direction + 2) % 4 == drive.directions.front();
    if (drive.length_m >= kLeastWayM && at == home && !turns_back) return drive;
    direction = choose_direction(at, home, direction, homewards, random);
  }
  return {};
}

// In the middle of the right-hand lane.
Route make_route(const Grid& grid, Random& random) {
  Drive drive;
  while (drive.crossings.empty()) drive = try_drive(grid, random);
  Route route;
  route.closed = true;
  route.corner_radius_m = 6.0;
  const auto right_of = [](int direction) {
    const Eigen::Vector2i& ahead = kDirections[static_cast<std::size_t>(direction)];
    return Eigen::Vector2d(ahead.y(), -ahead.x());
  };
  const std::size_t count = drive.crossings.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int in = drive.directions[(i + count - 1) % count];
    const int out = drive.directions[i];
    if (in == out) continue;
    const Eigen::Vector2d corner_m =
        grid.crossing_m(drive.crossings[i]) + 0.5 * kLaneM * (right_of(in) + right_of(out));
    route.points_m.emplace_back(corner_m.x(), corner_m.y(), 0.0);
  }
  return route;
}

// A pool of houses for all rows.
NextHouse shared_houses(WorldBuilder& builder) {
  std::vector<HouseChoice> pool;
  for (const double width_m : {9.0, 9.0, 11.0, 12.0, 12.5, 14.0, 15.0, 16.0, 18.0, 18.0, 22.0}) {
    pool.push_back({house(builder, width_m, kHouseDepthM, 1 + builder.random().below(4)), width_m,
                    kHouseDepthM});
  }
  return [&builder, pool = std::move(pool)](double room_m) {
    // Widths rise: the first `fitting` of them have room.
    const auto fitting = std::count_if(pool.begin(), pool.end(), [&](const HouseChoice& house) {
      return house.width_m <= room_m;
    });
    return pool[static_cast<std::size_t>(builder.random().below(static_cast<int>(fitting)))];
  };
}

void add_ground(WorldBuilder& builder, const Grid& grid) {
  const Look paving{builder.material(Material::kPaving), kSunlight};
  const Look lawn{builder.material(Material::kGrass), kSunlight};
  const Eigen::Vector2d far_m = grid.crossing_m({kBlocks, kBlocks});
  constexpr double kAroundM = 60.0;
  builder.add(
      level({-kAroundM, -kAroundM, 0.0}, far_m.x() + 2.0 * kAroundM, far_m.y() + 2.0 * kAroundM),
      {builder.material(Material::kAsphalt), kSunlight});
  for (int i = 0; i < kBlocks; ++i) {
    for (int j = 0; j < kBlocks; ++j) {
      const Eigen::Vector2d corner_m = grid.block_corner_m(i, j);
      add_box(builder.surfaces(),
              {corner_m.x() + 0.5 * grid.block_x, corner_m.y() + 0.5 * grid.block_y, 0.0},
              {grid.block_x, grid.block_y, kKerbM}, 0.0, paving);
      // A yard of grass in the middle.
      builder.add(level({corner_m.x() + 15.0, corner_m.y() + 15.0, kKerbM + 0.02},
                        grid.block_x - 30.0, grid.block_y - 30.0),
                  lawn);
    }
  }
  const auto street_line = [&](const Eigen::Vector2i& from, const Eigen::Vector2i& to) {
    const Eigen::Vector2d ahead = (grid.crossing_m(to) - grid.crossing_m(from)).normalized();
    paint_line(builder, grid.crossing_m(from) + 8.0 * ahead, grid.crossing_m(to) - 8.0 * ahead,
               0.12, true);
  };
  for (int i = 0; i <= kBlocks; ++i) {
    for (int j = 0; j < kBlocks; ++j) {
      street_line({i, j}, {i, j + 1});
      street_line({j, i}, {j + 1, i});
    }
  }
}

void add_blocks(WorldBuilder& builder, const Grid& grid, const StreetThings& things) {
  const NextHouse next_house = shared_houses(builder);
  const auto build = [&](const StreetSide& side) {
    // Some sides are open.
    if (builder.random().chance(0.85)) {
      const double begin_m = kPavementM + builder.random().uniform(0.0, 12.0);
      build_row(builder, side, begin_m, side.length_m - kPavementM - kHouseDepthM, next_house);
    }
    furnish(builder, side, things);
  };
  for (int i = 0; i < kBlocks; ++i) {
    for (int j = 0; j < kBlocks; ++j) {
      for (const StreetSide& side :
           sides_of_block(grid.block_corner_m(i, j), grid.block_x, grid.block_y)) {
        build(side);
      }
    }
  }
  const Eigen::Vector2d size_m =
      grid.crossing_m({kBlocks, kBlocks}) + Eigen::Vector2d::Constant(kRoadM);
  for (const StreetSide& side :
       sides_around(Eigen::Vector2d::Constant(-0.5 * kRoadM), size_m.x(), size_m.y())) {
    build(side);
  }
}

// Cars that drive round blocks, in lanes that the route never uses.
void add_traffic(WorldBuilder& builder, const Grid& grid, const Route& route,
                 const StreetThings& things) {
  Random& random = builder.random();
  constexpr double kOutM = kParkingLaneM + 0.5 * kLaneM;
  std::vector<RoundWay> free;
  for (int i = 0; i < kBlocks; ++i) {
    for (int j = 0; j < kBlocks; ++j) {
      const Eigen::Vector2d middle_m =
          grid.block_corner_m(i, j) + 0.5 * Eigen::Vector2d(grid.block_x, grid.block_y);
      const RoundWay way({middle_m.x(), middle_m.y(), 0.0}, grid.block_x + 2.0 * kOutM,
                         grid.block_y + 2.0 * kOutM, 4.0, 0.0, true);
      bool clear = true;
      for (double way_m = 0.0; clear && way_m < way.length_m(); way_m += 1.0) {
        clear = distance_to_route_m(route, way.at(way_m).translation_m.head<2>()) > kClearOfRouteM;
      }
      if (clear) free.push_back(way);
    }
  }
  for (int loops = 0; loops < kMovingLoops && !free.empty(); ++loops) {
    const auto index = random.below(static_cast<int>(free.size()));
    const RoundWay way = free[static_cast<std::size_t>(index)];
    free.erase(free.begin() + index);
    const double speed_mps = random.uniform(6.0, 9.0);
    const double start_m = random.uniform(0.0, way.length_m());
    add_driver(builder, things, way, start_m, speed_mps);
    if (random.chance(0.5)) {
      add_driver(builder, things, way, start_m + 0.5 * way.length_m(), speed_mps);
    }
  }
}

}  // namespace

World make_campus(WorldBuilder& builder) {
  Random& random = builder.random();
  const double block_x = random.uniform(74.0, 86.0);
  const Grid grid{block_x, random.uniform(60.0, 72.0)};
  Route route = make_route(grid, random);
  const StreetThings things = make_street_things(builder);
  add_ground(builder, grid);
  add_blocks(builder, grid, things);
  add_traffic(builder, grid, route, things);
  return builder.finish(std::move(route), "vehicle");
}

}  // namespace glint::synth
