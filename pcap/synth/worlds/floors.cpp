// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <algorithm>

#include "pcap/synth/paint/decoration.hpp"
#include "pcap/synth/worlds/climbing.hpp"
#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr double kStorySlabM = 0.4;
// From the corridor to the first step; from the last step to the far wall.
constexpr double kHallM = 1.3;
constexpr double kLandingM = 1.5;
constexpr double kPicturesApartM = 9.0;

// A storey: a corridor from the stairs at x = 0 along x, one from its end along y, a lounge there.
struct Plan {
  double width_m;  ///< Of the corridors, and of both flights side by side.
  double long_m;   ///< First corridor.
  double short_m;  ///< Second.
  double lounge_x;
  double lounge_y;
  int risers;  ///< Of a flight.

  [[nodiscard]] double storey_m() const { return 2.0 * risers * kRiseM; }
  [[nodiscard]] double room_m() const { return storey_m() - kStorySlabM; }
  [[nodiscard]] double flight_width_m() const { return 0.5 * width_m - 0.05; }
  [[nodiscard]] double flight_m() const { return (risers - 1) * kTreadM; }
  [[nodiscard]] double stairwell_m() const { return kHallM + flight_m() + kLandingM; }
  [[nodiscard]] double far_x() const { return long_m - width_m; }
  [[nodiscard]] double far_y() const { return width_m + short_m; }
  [[nodiscard]] double lounge_from_x() const { return long_m - lounge_x; }
  [[nodiscard]] double top_y() const { return far_y() + lounge_y; }
  /// Its walls, with the air on the right.
  [[nodiscard]] std::vector<Eigen::Vector3d> corners_m() const {
    return {{0, width_m, 0},
            {far_x(), width_m, 0},
            {far_x(), far_y(), 0},
            {lounge_from_x(), far_y(), 0},
            {lounge_from_x(), top_y(), 0},
            {long_m, top_y(), 0},
            {long_m, 0, 0},
            {0, 0, 0}};
  }
  /// From the lounge to the stairs, on the ground floor.
  [[nodiscard]] std::vector<Eigen::Vector3d> way_m() const {
    const double middle_x = far_x() + 0.5 * width_m;
    const double middle_y = far_y() + 0.5 * lounge_y;
    return {{long_m - 0.75 * lounge_x, middle_y, 0},
            {middle_x, middle_y, 0},
            {middle_x, 0.5 * width_m, 0},
            {0.6, 0.5 * width_m, 0}};
  }
};

// All that both floors have, seen and touched alike.
BodyPtr make_storey(WorldBuilder& builder, const Plan& plan) {
  Random& random = builder.random();
  Surfaces surfaces;
  add_walls(surfaces, plan.corners_m(), plan.room_m(), [&](double width_m, double height_m) {
    return Look{office_wall(width_m, height_m, random), kLampLight};
  });
  const auto cover = [&](const Eigen::Vector3d& corner_m, double x_m, double y_m) {
    add(surfaces, level(corner_m, x_m, y_m), {office_floor(x_m, y_m, random), kLampLight});
    add(surfaces, overhead(corner_m + plan.room_m() * Eigen::Vector3d::UnitZ(), x_m, y_m),
        {panel_ceiling(x_m, y_m, random), kLampShade});
  };
  cover({0, 0, 0}, plan.long_m, plan.width_m);
  cover({plan.far_x(), plan.width_m, 0}, plan.width_m, plan.short_m);
  cover({plan.lounge_from_x(), plan.far_y(), 0}, plan.lounge_x, plan.lounge_y);

  const FaceLook side = [&](double width_m, double height_m) {
    return Look{furniture_side(width_m, height_m, random), kLampShade};
  };
  for (double x = plan.lounge_from_x() + 0.8; x < plan.long_m - 0.8;
       x += random.uniform(1.5, 2.5)) {
    add_box(surfaces, {x, plan.top_y() - 0.3, 0},
            {random.uniform(0.6, 1.2), 0.5, random.uniform(0.7, 1.9)}, 0.0, side);
  }
  add_box(surfaces, {plan.lounge_from_x() + 1.2, plan.far_y() + 0.5, 0}, {1.6, 0.7, 0.75}, 0.0,
          side);
  add_box(surfaces, {random.uniform(6.0, 0.6 * plan.long_m), 0.2, 0}, {0.9, 0.36, 1.0}, 0.0, side);
  return std::make_shared<const Body>(std::move(surfaces));
}

// Up to the landing, and from there on.
struct Flights {
  Flight up;
  Flight on;

  explicit Flights(const Plan& plan)
      : up{{-kHallM, 0.5 * plan.flight_width_m(), 0.0},
           -Eigen::Vector3d::UnitX(),
           plan.flight_width_m(),
           plan.risers},
        on{{-kHallM - plan.flight_m(), plan.width_m - 0.5 * plan.flight_width_m(),
            0.5 * plan.storey_m()},
           Eigen::Vector3d::UnitX(),
           plan.flight_width_m(),
           plan.risers} {}
};

void add_stairwell(WorldBuilder& builder, const Plan& plan, const Flights& flights) {
  Random& random = builder.random();
  Surfaces& surfaces = builder.surfaces();
  const Look wall{builder.material(Material::kPlaster), kLampShade};
  const FaceLook wall_face = [&](double, double) { return Look(wall); };
  const Look step{builder.material(Material::kConcrete), kLampShade};
  const Look rail{builder.material(Material::kMetal), kLampShade};
  const double top_m = plan.storey_m() + plan.room_m();
  add_walls(surfaces,
            {{0, 0, 0},
             {-plan.stairwell_m(), 0, 0},
             {-plan.stairwell_m(), plan.width_m, 0},
             {0, plan.width_m, 0}},
            top_m, wall_face);
  add(surfaces, level({-plan.stairwell_m(), 0, 0}, plan.stairwell_m(), plan.width_m), step);
  add(surfaces, overhead({-plan.stairwell_m(), 0, top_m}, plan.stairwell_m(), plan.width_m), wall);

  add_flight(surfaces, flights.up, step, step);
  add_flight(surfaces, flights.on, step, step);
  // The landing and the upper storey's end, both seen from above, below and before.
  const double landing_z = 0.5 * plan.storey_m();
  const double landing_x = -kHallM - plan.flight_m();
  add(surfaces, level({-plan.stairwell_m(), 0, landing_z}, kLandingM, plan.width_m), step);
  add(surfaces, overhead({-plan.stairwell_m(), 0, landing_z - 0.2}, kLandingM, plan.width_m), wall);
  add(surfaces,
      upright({landing_x, 0, landing_z - 0.2}, {landing_x, plan.width_m, landing_z - 0.2}, 0.2),
      step);
  add(surfaces, level({-kHallM, 0, plan.storey_m()}, kHallM, plan.width_m), step);
  add(surfaces, overhead({-kHallM, 0, plan.room_m()}, kHallM, plan.width_m), wall);
  add(surfaces,
      upright({-kHallM, plan.width_m, plan.room_m()}, {-kHallM, 0, plan.room_m()}, kStorySlabM),
      step);

  const double between_y = 0.5 * plan.width_m;
  add_railing(surfaces, {-kHallM, between_y, 0.2}, {landing_x, between_y, landing_z}, rail);
  add_railing(surfaces, {landing_x, between_y, landing_z}, {-kHallM, between_y, plan.storey_m()},
              rail);
  add_railing(surfaces, {-kHallM, between_y, plan.storey_m()}, {-kHallM, 0.0, plan.storey_m()},
              rail);
  const Rectangle far_wall = upright({-plan.stairwell_m(), 0, landing_z},
                                     {-plan.stairwell_m(), plan.width_m, landing_z}, plan.room_m());
  builder.hang_poster(far_wall, {random.uniform(0.2, 1.5), 1.0, 0.7, 0.9}, kLampShade);
}

Route make_route(const Plan& plan, const Flights& flights) {
  Route route;
  route.corner_radius_m = 0.6;
  route.clear_height_m = plan.room_m() - 0.2;
  route.points_m = plan.way_m();
  // One turns in the middle of the landing, before the far wall.
  const Eigen::Vector3d onto_landing(-0.5 * kLandingM, 0.0, 0.0);
  const Eigen::Vector3d& next_foot_m = flights.on.foot_m;
  for (const Eigen::Vector3d& point_m :
       {Eigen::Vector3d(flights.up.begin_m() + 0.3 * Eigen::Vector3d::UnitX()),
        flights.up.begin_m(), flights.up.end_m(),
        Eigen::Vector3d(flights.up.end_m() + onto_landing),
        Eigen::Vector3d(next_foot_m + onto_landing), flights.on.begin_m(), flights.on.end_m(),
        Eigen::Vector3d(flights.on.end_m() + 0.6 * Eigen::Vector3d::UnitX())}) {
    route.points_m.push_back(point_m);
  }
  std::vector<Eigen::Vector3d> upstairs_m = plan.way_m();
  std::reverse(upstairs_m.begin(), upstairs_m.end());
  for (const Eigen::Vector3d& point_m : upstairs_m) {
    route.points_m.emplace_back(point_m + plan.storey_m() * Eigen::Vector3d::UnitZ());
  }
  return route;
}

}  // namespace

World make_floors(WorldBuilder& builder) {
  Random& random = builder.random();
  const Plan plan{.width_m = random.uniform(2.4, 2.9),
                  .long_m = random.uniform(30.0, 38.0),
                  .short_m = random.uniform(14.0, 22.0),
                  .lounge_x = random.uniform(6.5, 9.0),
                  .lounge_y = random.uniform(5.0, 7.0),
                  .risers = 9 + random.below(2)};
  const Flights flights(plan);
  const auto storey = make_storey(builder, plan);
  add_stairwell(builder, plan, flights);
  for (const double z : {0.0, plan.storey_m()}) {
    const Eigen::Vector3d up_m(0, 0, z);
    builder.place(storey, up_m, 0.0);
    // What tells the floors apart.
    const auto corners_m = plan.corners_m();
    for (std::size_t i = 0; i + 1 < corners_m.size(); ++i) {
      const Rectangle wall = upright(corners_m[i] + up_m, corners_m[i + 1] + up_m, plan.room_m());
      builder.hang_pictures(wall, 0.5, wall.width_m, kPicturesApartM, kLampLight);
    }
  }

  return builder.finish(make_route(plan, flights), "walking");
}

}  // namespace glint::synth
