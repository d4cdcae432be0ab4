// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/things.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr double kHalfM = 80.0;  // The land reaches so far from its middle.
constexpr double kCellM = 2.0;
constexpr double kLoopM = 400.0;
constexpr double kPathM = 1.4;  // A trodden path's half width.

// A sum of waves in all directions.
class Waves {
 public:
  Waves(int count, double least_m, double most_m, Random& random) {
    for (int i = 0; i < count; ++i) {
      const double length_m = least_m * std::pow(most_m / least_m, random.uniform());
      const double heading_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double number = 2.0 * std::numbers::pi / length_m;
      waves_.push_back({number * std::cos(heading_rad), number * std::sin(heading_rad),
                        random.uniform(0.0, 2.0 * std::numbers::pi),
                        length_m * random.uniform(0.3, 1.0)});
    }
  }

  [[nodiscard]] double at(double x, double y) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) {
      sum += wave.height * std::cos(wave.kx * x + wave.ky * y + wave.phase_rad);
    }
    return sum;
  }
  [[nodiscard]] double slope(double x, double y) const {
    double dx = 0.0;
    double dy = 0.0;
    for (const Wave& wave : waves_) {
      const double s = wave.height * std::sin(wave.kx * x + wave.ky * y + wave.phase_rad);
      dx -= wave.kx * s;
      dy -= wave.ky * s;
    }
    return std::hypot(dx, dy);
  }
  void scale(double factor) {
    for (Wave& wave : waves_) wave.height *= factor;
  }

 private:
  struct Wave {
    double kx;
    double ky;
    double phase_rad;
    double height;
  };
  std::vector<Wave> waves_;
};

// Calls visit(x, y) for each cell's lower left corner.
template <class Visit>
void each_cell(Visit&& visit) {
  constexpr int kCells = static_cast<int>(2.0 * kHalfM / kCellM);
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) visit(-kHalfM + i * kCellM, -kHalfM + j * kCellM);
  }
}

Waves make_land(Random& random) {
  Waves land(28, 18.0, 110.0, random);
  double steepest = 0.0;
  each_cell([&](double x, double y) { steepest = std::max(steepest, land.slope(x, y)); });
  const double wanted_rad = random.uniform(12.0, 15.0) * std::numbers::pi / 180.0;
  land.scale(std::tan(wanted_rad) / steepest);
  return land;
}

// A round walk that winds, on the ground.
Route make_walk(const Waves& land, Random& random) {
  struct Lobe {
    double depth;
    double phase_rad;
  };
  std::vector<Lobe> lobes;
  for (int i = 0; i < 4; ++i) {
    lobes.push_back({random.uniform(0.02, 0.07), random.uniform(0.0, 2.0 * std::numbers::pi)});
  }
  Route route;
  route.closed = true;
  route.corner_radius_m = 8.0;
  constexpr int kPoints = 120;
  for (int i = 0; i < kPoints; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kPoints;
    double radius = 1.0;
    for (std::size_t k = 0; k < lobes.size(); ++k) {
      radius +=
          lobes[k].depth * std::cos(static_cast<double>(k + 2) * angle_rad + lobes[k].phase_rad);
    }
    route.points_m.emplace_back(radius * std::cos(angle_rad), radius * std::sin(angle_rad), 0.0);
  }
  const double scale = kLoopM / length_m(route);
  for (Eigen::Vector3d& point_m : route.points_m) {
    point_m *= scale;
    point_m.z() = land.at(point_m.x(), point_m.y());
  }
  start_anywhere(route, random);
  return route;
}

void add_land(WorldBuilder& builder, const Waves& land, const Route& route) {
  const Waves soils(16, 8.0, 40.0, builder.random());
  const Look grass{builder.material(Material::kGrass), kSunlight};
  const Look earth{builder.material(Material::kEarth), kSunlight};
  const auto ground = [&](double x, double y) { return Eigen::Vector3d(x, y, land.at(x, y)); };
  const auto triangle = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c) {
    const Eigen::Vector3d middle = (a + b + c) / 3.0;
    const bool bare = soils.at(middle.x(), middle.y()) > 55.0 ||
                      distance_to_route_m(route, middle.head<2>()) < kPathM;
    // All share one picture, seen from above.
    builder.add(Triangle{a, b, c, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()},
                bare ? earth : grass);
  };
  each_cell([&](double x, double y) {
    const Eigen::Vector3d a = ground(x, y);
    const Eigen::Vector3d b = ground(x + kCellM, y);
    const Eigen::Vector3d c = ground(x + kCellM, y + kCellM);
    const Eigen::Vector3d d = ground(x, y + kCellM);
    triangle(a, b, c);
    triangle(a, c, d);
  });
}

// Places `count` of the variants on the ground, so far from the way.
void strew(WorldBuilder& builder, const Waves& land, const Route& route, const Variants& things,
           int count, double clear_m) {
  Random& random = builder.random();
  while (count > 0) {
    const double x = random.uniform(-kHalfM + 2.0, kHalfM - 2.0);
    const double y = random.uniform(-kHalfM + 2.0, kHalfM - 2.0);
    if (distance_to_route_m(route, {x, y}) < clear_m) continue;
    builder.place_any(things, {x, y, land.at(x, y)}, random.uniform(0.0, 2.0 * std::numbers::pi));
    --count;
  }
}

}  // namespace

World make_hill(WorldBuilder& builder) {
  Random& random = builder.random();
  const Waves land = make_land(random);
  Route route = make_walk(land, random);
  add_land(builder, land, route);
  // Crowns begin above one's head, uphill too.
  const Variants trees = variants(7, [&] { return tree(builder); });
  strew(builder, land, route, trees, 100 + random.below(51), 3.0);
  const Variants rocks = variants(6, [&] { return rock(builder); });
  strew(builder, land, route, rocks, 40 + random.below(41), 3.0);
  return builder.finish(std::move(route), "walking");
}

}  // namespace glint::synth
