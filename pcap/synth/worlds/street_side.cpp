// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/worlds/street_side.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint::synth {
namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
constexpr double kClearOfCornersM = 7.0;
// Paint on the road, above it by so much.
constexpr double kPaintM = 0.003;

}  // namespace

Eigen::Vector3d StreetSide::at(double along_m, double left_m, double z_m) const {
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const Eigen::Vector2d place_m = from_m + along_m * ahead + left_m * left;
  return {place_m.x(), place_m.y(), z_m};
}

double StreetSide::heading_rad() const { return std::atan2(ahead.y(), ahead.x()); }

std::vector<StreetSide> sides_of_block(const Eigen::Vector2d& corner_m, double x_m, double y_m) {
  const Eigen::Vector2d x = x_m * Eigen::Vector2d::UnitX();
  const Eigen::Vector2d y = y_m * Eigen::Vector2d::UnitY();
  return {{corner_m, Eigen::Vector2d::UnitX(), x_m},
          {corner_m + x, Eigen::Vector2d::UnitY(), y_m},
          {corner_m + x + y, -Eigen::Vector2d::UnitX(), x_m},
          {corner_m + y, -Eigen::Vector2d::UnitY(), y_m}};
}

std::vector<StreetSide> sides_around(const Eigen::Vector2d& corner_m, double x_m, double y_m) {
  std::vector<StreetSide> sides = sides_of_block(corner_m, x_m, y_m);
  for (StreetSide& side : sides) {
    side.from_m += side.length_m * side.ahead;
    side.ahead = -side.ahead;
  }
  return sides;
}

StreetThings make_street_things(WorldBuilder& builder) {
  return {variants(10, [&] { return car(builder); }), variants(6, [&] { return tree(builder); }),
          variants(3, [&] { return lamp_pole(builder); }),
          variants(6, [&] { return sign_pole(builder); }),
          variants(6, [&] { return person(builder); })};
}

void build_row(WorldBuilder& builder, const StreetSide& side, double begin_m, double end_m,
               const NextHouse& next_house) {
  constexpr double kNarrowestM = 9.0;
  Random& random = builder.random();
  const Look garden_wall{builder.material(Material::kBrick), kSunShade};
  for (double at_m = begin_m; end_m - at_m >= kNarrowestM;) {
    const HouseChoice house = next_house(end_m - at_m);
    builder.place(house.body, side.at(at_m + 0.5 * house.width_m, kPavementM + 0.5 * house.depth_m),
                  side.heading_rad());
    at_m += house.width_m;
    if (random.chance(0.45)) continue;
    const double gap_m = random.uniform(1.5, 5.0);
    const double height_m = random.uniform(1.2, 2.0);
    if (at_m + gap_m > end_m) break;
    builder.add(upright(side.at(at_m, kPavementM), side.at(at_m + gap_m, kPavementM), height_m),
                garden_wall);
    if (random.chance(0.5)) {
      const Rectangle wall =
          upright(side.at(at_m, kPavementM), side.at(at_m + gap_m, kPavementM), height_m);
      builder.hang_poster(wall, {0.2, 0.4, 0.6, 0.75}, kSunShade);
    }
    at_m += gap_m;
  }
}

void furnish(WorldBuilder& builder, const StreetSide& side, const StreetThings& things) {
  Random& random = builder.random();
  const double end_m = side.length_m - kClearOfCornersM;
  const double heading_rad = side.heading_rad();
  for (double at_m = random.uniform(3.0, 20.0); at_m < side.length_m - 3.0;
       at_m += random.uniform(20.0, 30.0)) {
    builder.place_any(things.lamps, side.at(at_m, 0.35, kKerbM), heading_rad - kQuarterTurn);
  }
  for (double at_m = random.uniform(4.0, 12.0); at_m < side.length_m - 4.0;
       at_m += random.uniform(8.0, 18.0)) {
    builder.place_any(things.trees, side.at(at_m, 0.75, kKerbM),
                      random.uniform(0.0, 2.0 * std::numbers::pi));
  }
  for (double at_m = random.uniform(3.0, 30.0); at_m < end_m; at_m += random.uniform(15.0, 45.0)) {
    builder.place_any(things.signs, side.at(at_m, 0.4, kKerbM), heading_rad);
  }
  for (double at_m = kClearOfCornersM + 2.6; at_m < end_m - 2.6; at_m += random.uniform(5.4, 6.4)) {
    if (random.chance(0.35)) continue;
    // Most of them in the direction of the traffic.
    const double turned_rad = random.chance(0.85) ? std::numbers::pi : 0.0;
    builder.place_any(things.cars,
                      side.at(at_m, -0.5 * kParkingLaneM + random.uniform(-0.08, 0.08)),
                      heading_rad + turned_rad + random.uniform(-0.03, 0.03));
  }
}

void add_walker(WorldBuilder& builder, const StreetSide& side, const StreetThings& things) {
  Random& random = builder.random();
  const double reach_m = std::min(random.uniform(12.0, 40.0), side.length_m - 4.0);
  const double middle_m = random.uniform(0.5 * reach_m + 2.0, side.length_m - 0.5 * reach_m - 2.0);
  // Between the trees and the houses.
  constexpr double kLaneM = 1.7;
  const RoundWay way(side.at(middle_m, kLaneM, kKerbM), reach_m, 0.6, 0.3, side.heading_rad(),
                     random.chance(0.5));
  const double start_m = random.uniform(0.0, way.length_m());
  const double speed_mps = random.uniform(0.9, 1.5);
  const auto index = static_cast<std::size_t>(random.below(static_cast<int>(things.people.size())));
  builder.add_mover(things.people[index],
                    [=](double t_s) { return way.at(start_m + speed_mps * t_s); });
}

void add_driver(WorldBuilder& builder, const StreetThings& things, const RoundWay& way,
                double start_m, double speed_mps) {
  const int index = builder.random().below(static_cast<int>(things.cars.size()));
  builder.add_mover(things.cars[static_cast<std::size_t>(index)],
                    [=](double t_s) { return way.at(start_m + speed_mps * t_s); });
}

void paint_line(WorldBuilder& builder, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                double width_m, bool dashed) {
  constexpr double kDashM = 3.0;
  constexpr double kGapM = 4.0;
  const Look paint{builder.material(Material::kRoadPaint), kSunlight};
  const double length_m = (to_m - from_m).norm();
  const Eigen::Vector2d ahead = (to_m - from_m) / length_m;
  const Eigen::Vector3d u_axis(ahead.x(), ahead.y(), 0.0);
  const Eigen::Vector3d v_axis(-ahead.y(), ahead.x(), 0.0);
  const double piece_m = dashed ? kDashM : length_m;
  for (double at_m = 0.0; at_m + 0.5 * piece_m <= length_m; at_m += piece_m + kGapM) {
    const Eigen::Vector3d start_m(from_m.x() + at_m * ahead.x(), from_m.y() + at_m * ahead.y(),
                                  kPaintM);
    builder.add(Rectangle{start_m - 0.5 * width_m * v_axis, u_axis, v_axis, piece_m, width_m},
                paint);
  }
}

}  // namespace glint::synth
