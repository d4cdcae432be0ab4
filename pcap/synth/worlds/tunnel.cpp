// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <cmath>
#include <numbers>

#include "pcap/synth/paint/coats.hpp"
#include "pcap/synth/paint/pictures.hpp"
#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr double kLengthM = 400.0;
constexpr double kEndMarginM = 10.0;
constexpr double kTexelM = 0.03;
constexpr double kSquareWidthM = 5.0;
constexpr double kSquareHeightM = 4.0;
const Eigen::Vector3d kAhead = Eigen::Vector3d::UnitX();

// A round tunnel's cross-section; the floor is at z = 0.
struct Bore {
  double radius_m;
  double axis_m;  ///< Height of the middle line.

  [[nodiscard]] double half_floor_m() const {
    return std::sqrt(radius_m * radius_m - axis_m * axis_m);
  }
};

Bore choose_bore(Random& random) {
  const double radius_m = random.uniform(2.6, 3.4);
  return {radius_m, 0.5 * radius_m};
}

// Lining all along, in rings, stained and patched.
Canvas lining(double round_m, Random& random) {
  const double albedo = random.uniform(0.28, 0.42);
  Canvas canvas(kLengthM, round_m, kTexelM, albedo);
  const double ring_m = random.uniform(1.2, 2.0);
  for (double u = ring_m; u < kLengthM; u += ring_m) {
    canvas.fill({u, 0.0, kTexelM, round_m}, 0.6 * albedo);
  }
  const auto somewhere = [&] { return random.uniform(0.0, kLengthM); };
  for (int i = 0; i < 260; ++i) {
    const double u = somewhere();
    draw_stain(canvas, u, random.uniform(0.0, round_m), random.uniform(0.2, 1.2), random);
  }
  for (int i = 0; i < 60; ++i) {
    const double u = somewhere();
    draw_crack(canvas, u, random.uniform(0.0, round_m), random.uniform(0.0, std::numbers::pi),
               random.uniform(0.5, 4.0), 0.035, 0.4 * albedo, random);
  }
  for (int i = 0; i < 40; ++i) {
    const double u = somewhere();
    canvas.fill(
        {u, random.uniform(0.0, round_m), random.uniform(0.2, 1.0), random.uniform(0.2, 0.8)},
        albedo * random.uniform(0.75, 1.3));
  }
  roughen(canvas, canvas.whole(), {{8.0, 0.12}, {2.0, 0.12}, {0.5, 0.08}, {0.12, 0.08}}, random);
  return canvas;
}

// Calls mark(way_m) at uneven distances.
template <class Mark>
void each_mark(double least_m, double most_m, Random& random, Mark&& mark) {
  for (double u = random.uniform(3.0, most_m); u < kLengthM - 3.0;
       u += random.uniform(least_m, most_m)) {
    mark(u);
  }
}

std::shared_ptr<const AlbedoMap> finished(const Canvas& canvas) {
  return std::make_shared<const AlbedoMap>(canvas);
}

// Boxes under the roof.
void add_lamps(WorldBuilder& builder, double roof_m) {
  const Look look{plain(0.8), kLampLight};
  each_mark(10.0, 25.0, builder.random(), [&](double way_m) {
    add_box(builder.surfaces(), {way_m, builder.random().uniform(-0.3, 0.3), roof_m - 0.25},
            {1.2, 0.25, 0.12}, 0.0, look);
  });
}

// A plate on a wall: `foot_m` is its lower edge's middle.
void add_plate(WorldBuilder& builder, const Eigen::Vector3d& foot_m,
               const Eigen::Vector3d& normal) {
  Random& random = builder.random();
  const double width_m = random.uniform(0.3, 0.7);
  const double height_m = random.uniform(0.25, 0.5);
  const Eigen::Vector3d u_axis = Eigen::Vector3d::UnitZ().cross(normal).normalized();
  const Rectangle wall{foot_m - 0.5 * width_m * u_axis, u_axis, normal.cross(u_axis), width_m,
                       height_m};
  builder.hang_sign(wall, {0.0, 0.0, width_m, height_m}, kLampLight);
}

World finish(WorldBuilder& builder, double height_m) {
  Route route = straying_route({kEndMarginM, 0.0, 0.0}, {kLengthM - kEndMarginM, 0.0, 0.0}, 10.0,
                               0.3, builder.random());
  route.corner_radius_m = 30.0;
  route.clear_height_m = height_m;
  return builder.finish(std::move(route), "wheeled");
}

World round_tunnel(WorldBuilder& builder, const Bore& bore, const Look& lining_look,
                   const Look& floor) {
  builder.add(Tube{{0.0, 0.0, bore.axis_m}, kAhead, bore.radius_m, kLengthM}, lining_look);
  const double half_m = bore.half_floor_m();
  builder.add(level({0.0, -half_m, 0.0}, kLengthM, 2.0 * half_m), floor);
  return finish(builder, bore.axis_m + bore.radius_m - 0.3);
}

}  // namespace

World make_tunnel(WorldBuilder& builder) {
  Random& random = builder.random();
  const Bore bore = choose_bore(random);
  const double round_m = 2.0 * std::numbers::pi * bore.radius_m;
  Canvas canvas = lining(round_m, random);
  // Where the floor meets the lining, metres round it from its lowest line.
  const double floor_m = bore.radius_m * std::acos(bore.axis_m / bore.radius_m);
  each_mark(20.0, 60.0, random, [&](double way_m) {
    // All on the side where v runs upwards.
    draw_niche(canvas, {way_m, floor_m, random.uniform(0.8, 1.2), random.uniform(1.7, 2.0)},
               random);
  });
  each_mark(12.0, 40.0, random, [&](double way_m) {
    const double up_m = random.uniform(1.2, 1.8) - bore.axis_m;
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const double out_m = side * std::sqrt(bore.radius_m * bore.radius_m - up_m * up_m);
    const Eigen::Vector3d normal = -Eigen::Vector3d(0.0, out_m, up_m) / bore.radius_m;
    // Its lower and upper edge must not dip into the lining.
    const Eigen::Vector3d on_wall(way_m, out_m, bore.axis_m + up_m);
    add_plate(builder, on_wall + 0.06 * normal, normal);
  });
  add_lamps(builder, bore.axis_m + bore.radius_m);
  return round_tunnel(builder, bore, {finished(canvas), kLampShade},
                      {builder.material(Material::kAsphalt), kLampShade});
}

World make_bare_tunnel(WorldBuilder& builder) {
  Random& random = builder.random();
  const auto hardly_anything = [&](double albedo) {
    Canvas canvas(10.24, 10.24, 0.04, albedo, Edges::kRepeat);
    roughen(canvas, canvas.whole(), {{3.0, 0.02}, {0.7, 0.02}}, random);
    return Look{finished(canvas), kLampShade};
  };
  const Bore bore = choose_bore(random);
  return round_tunnel(builder, bore, hardly_anything(0.35), hardly_anything(0.3));
}

World make_square_tunnel(WorldBuilder& builder) {
  Random& random = builder.random();
  const double half_m = 0.5 * kSquareWidthM;
  for (const double side : {-1.0, 1.0}) {
    Canvas canvas = lining(kSquareHeightM, random);
    each_mark(40.0, 100.0, random, [&](double way_m) {
      draw_niche(canvas, {way_m, 0.0, random.uniform(0.8, 1.2), random.uniform(1.7, 2.1)}, random);
    });
    const double y = side * half_m;
    const double from_x = side > 0.0 ? 0.0 : kLengthM;
    builder.add(upright({from_x, y, 0.0}, {kLengthM - from_x, y, 0.0}, kSquareHeightM),
                {finished(canvas), kLampShade});
    each_mark(25.0, 80.0, random, [&](double way_m) {
      add_plate(builder, {way_m, y, random.uniform(1.2, 1.8)}, {0.0, -side, 0.0});
    });
  }
  builder.add(level({0.0, -half_m, 0.0}, kLengthM, kSquareWidthM),
              {builder.material(Material::kAsphalt), kLampShade});
  builder.add(overhead({0.0, -half_m, kSquareHeightM}, kLengthM, kSquareWidthM),
              {builder.material(Material::kConcrete), kLampShade});
  add_lamps(builder, kSquareHeightM);
  return finish(builder, kSquareHeightM - 0.3);
}

}  // namespace glint::synth
