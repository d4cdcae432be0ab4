// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <array>

#include "pcap/synth/paint/decals.hpp"
#include "pcap/synth/worlds/things.hpp"

namespace glint::synth {
namespace {

// A car seen from its side, m: the flank from `sill` to `belt`, above it the cabin, whose edges are
// at these x, rear to front.
struct Profile {
  double length;
  double width;
  double height;
  double sill = 0.22;
  double belt;
  double rear_foot;  ///< Rear window's lower edge.
  double roof_rear;
  double roof_front;
  double front_foot;  ///< Windscreen's lower edge.
};

Profile choose_profile(Random& random) {
  Profile p;
  const double kind = random.uniform();
  if (kind < 0.15) {  // van
    p.length = random.uniform(4.8, 5.2);
    p.width = random.uniform(1.85, 1.9);
    p.height = random.uniform(1.9, 2.1);
    p.belt = 1.1;
    p.rear_foot = -0.5 * p.length + 0.03;
    p.roof_rear = p.rear_foot + 0.1;
  } else if (kind < 0.6) {  // hatchback
    p.length = random.uniform(3.8, 4.3);
    p.width = random.uniform(1.65, 1.8);
    p.height = random.uniform(1.45, 1.6);
    p.belt = 0.92;
    p.rear_foot = -0.5 * p.length + 0.1;
    p.roof_rear = p.rear_foot + 0.4;
  } else {  // saloon
    p.length = random.uniform(4.4, 4.9);
    p.width = random.uniform(1.75, 1.87);
    p.height = random.uniform(1.4, 1.5);
    p.belt = 0.9;
    p.rear_foot = -0.5 * p.length + 0.75;
    p.roof_rear = p.rear_foot + 0.65;
  }
  p.front_foot = 0.5 * p.length - random.uniform(0.95, 1.2);
  p.roof_front = p.front_foot - random.uniform(0.6, 0.8);
  return p;
}

struct CarLooks {
  Look paint;
  Look top;
  Look glass;
  Look flank;
  Look wheel;
};

// The side that looks along +y (`left`) or -y. Points on it are given as for the right side.
void add_side(Surfaces& surfaces, const Profile& p, const CarLooks& looks, bool left) {
  const double cabin_y = 0.5 * p.width - 0.07;
  const auto at = [&](double x, double y, double z) {
    return Eigen::Vector3d(x, left ? y : -y, z);
  };
  const auto wall = [&](double rear, double front, double y, double low, double high) {
    const Eigen::Vector3d a = at(rear, y, low);
    const Eigen::Vector3d b = at(front, y, low);
    return left ? upright(b, a, high - low) : upright(a, b, high - low);
  };
  const auto triangle = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c) {
    add_triangle(surfaces, left ? b : a, left ? a : b, c, looks.glass);
  };
  add(surfaces, wall(-0.5 * p.length, 0.5 * p.length, 0.5 * p.width, p.sill, p.belt), looks.flank);
  constexpr double kWheelM = 0.64;
  for (const double axle : {-0.29 * p.length, 0.31 * p.length}) {
    add(surfaces,
        wall(axle - 0.5 * kWheelM, axle + 0.5 * kWheelM, 0.5 * p.width + 0.01, 0.0, kWheelM),
        looks.wheel);
  }
  const Rectangle cabin = wall(p.roof_rear, p.roof_front, cabin_y, p.belt, p.height);
  add(surfaces, cabin, looks.paint);
  const double pane_m = 0.5 * cabin.width_m - 0.1;
  const double pane_height_m = cabin.height_m - 0.12;
  add_flush(surfaces, part(cabin, {0.05, 0.04, pane_m, pane_height_m}), looks.glass);
  add_flush(surfaces, part(cabin, {pane_m + 0.15, 0.04, pane_m, pane_height_m}), looks.glass);
  triangle(at(p.roof_front, cabin_y, p.belt), at(p.front_foot, cabin_y, p.belt),
           at(p.roof_front, cabin_y, p.height));
  triangle(at(p.rear_foot, cabin_y, p.belt), at(p.roof_rear, cabin_y, p.belt),
           at(p.roof_rear, cabin_y, p.height));
}

// Lamps and number plate on a face.
void add_fittings(Surfaces& surfaces, const Rectangle& face, double lamp_albedo, Random& random) {
  const Look lamp{plain(lamp_albedo), kSunShade};
  add_flush(surfaces, part(face, {0.08, face.height_m - 0.3, 0.3, 0.15}), lamp);
  add_flush(surfaces, part(face, {face.width_m - 0.38, face.height_m - 0.3, 0.3, 0.15}), lamp);
  add_flush(surfaces, part(face, {0.5 * face.width_m - 0.26, 0.2, 0.52, 0.12}),
            {number_plate(0.52, 0.12, random), kSunShade});
  add_flush(surfaces, part(face, {0.05, 0.02, face.width_m - 0.1, 0.1}), {plain(0.05), kSunShade});
}

}  // namespace

BodyPtr car(WorldBuilder& builder) {
  Random& random = builder.random();
  const Profile p = choose_profile(random);
  // White and silver are frequent; black drinks the light.
  constexpr std::array<double, 6> kPaints = {0.72, 0.6, 0.45, 0.3, 0.12, 0.06};
  const double paint =
      kPaints[static_cast<std::size_t>(random.below(6))] * random.uniform(0.9, 1.1);
  const auto paint_map = plain(paint);
  const auto glass_map = plain(random.uniform(0.03, 0.08));
  const CarLooks looks{{paint_map, kSunShade},
                       {paint_map, kSunlight},
                       {glass_map, kSunShade},
                       {car_flank(p.length, p.belt - p.sill, paint, random), kSunShade},
                       {wheel(0.64, random), kSunShade}};
  Surfaces surfaces;
  add_side(surfaces, p, looks, false);
  add_side(surfaces, p, looks, true);

  const double x = 0.5 * p.length;
  const double y = 0.5 * p.width;
  const Rectangle front = upright({x, -y, p.sill}, {x, y, p.sill}, p.belt - p.sill);
  const Rectangle rear = upright({-x, y, p.sill}, {-x, -y, p.sill}, p.belt - p.sill);
  add(surfaces, front, looks.paint);
  add(surfaces, rear, looks.paint);
  add_fittings(surfaces, front, 0.8, random);
  add_fittings(surfaces, rear, 0.95, random);
  add(surfaces, level({-x, -y, p.belt}, p.length, p.width), looks.top);

  const double cabin_y = y - 0.07;
  add(surfaces, level({p.roof_rear, -cabin_y, p.height}, p.roof_front - p.roof_rear, 2 * cabin_y),
      looks.top);
  const Rectangle windscreen =
      between({p.front_foot, -cabin_y, p.belt}, {p.front_foot, cabin_y, p.belt},
              {p.roof_front, -cabin_y, p.height});
  const Rectangle rear_window =
      between({p.rear_foot, cabin_y, p.belt}, {p.rear_foot, -cabin_y, p.belt},
              {p.roof_rear, cabin_y, p.height});
  for (const Rectangle& pane : {windscreen, rear_window}) {
    add(surfaces, pane, looks.paint);
    add_flush(surfaces, part(pane, {0.06, 0.05, pane.width_m - 0.12, pane.height_m - 0.1}),
              looks.glass);
  }
  return std::make_shared<const Body>(std::move(surfaces));
}

}  // namespace glint::synth
