// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <cmath>
#include <memory>
#include <numbers>

#include "pcap/synth/shell.hpp"
#include "pcap/synth/spline_path.hpp"
#include "pcap/synth/world.hpp"

namespace glint::synth {
namespace {

constexpr double kLengthM = 12.0;
constexpr double kWidthM = 9.0;
constexpr double kCenterX = 0.5 * kLengthM;
constexpr double kCenterY = 0.5 * kWidthM;
// The way round the middle: half its size, how far it may stray, and what stays clear of it.
constexpr double kWayX = 3.9;
constexpr double kWayY = 2.4;
constexpr double kStrayM = 0.25;
constexpr int kWayPoints = 14;
constexpr double kIslandX = 2.0;
constexpr double kIslandY = 0.7;

// A closed way between a rectangle and an ellipse, begun anywhere, in either direction.
std::shared_ptr<const SplinePath> way_round(Random& random) {
  const double start_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double direction = random.chance(0.5) ? 1.0 : -1.0;
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < kWayPoints; ++i) {
    const double angle_rad = start_rad + direction * 2.0 * std::numbers::pi * i / kWayPoints;
    const double c = std::cos(angle_rad);
    const double s = std::sin(angle_rad);
    // |x/a|^3 + |y/b|^3 = 1.
    const double scale =
        std::pow(std::pow(std::abs(c), 3.0) + std::pow(std::abs(s), 3.0), -1.0 / 3);
    const double stray_m = random.uniform(-kStrayM, kStrayM);
    points_m.emplace_back(kCenterX + (kWayX * scale + stray_m) * c,
                          kCenterY + (kWayY * scale + stray_m) * s);
  }
  return std::make_shared<const SplinePath>(std::move(points_m), true);
}

// Shelves and cabinets along the walls, with gaps.
void add_wall_furniture(std::vector<Surface>& surfaces, Random& random) {
  const auto line_up = [&](double wall_m, auto&& place) {
    for (double at_m = random.uniform(0.5, 1.5); at_m < wall_m - 1.5;) {
      const Eigen::Vector3d size_m(random.uniform(0.5, 1.3), random.uniform(0.3, 0.6),
                                   random.uniform(0.6, 2.1));
      place(at_m + 0.5 * size_m.x(), size_m);
      at_m += size_m.x() + random.uniform(0.8, 2.5);
    }
  };
  line_up(kLengthM, [&](double at_m, const Eigen::Vector3d& size_m) {
    add_box(surfaces, {at_m, 0.5 * size_m.y(), 0.0}, size_m, 0.0, random);
  });
  line_up(kLengthM, [&](double at_m, const Eigen::Vector3d& size_m) {
    add_box(surfaces, {at_m, kWidthM - 0.5 * size_m.y(), 0.0}, size_m, 0.0, random);
  });
  line_up(kWidthM, [&](double at_m, const Eigen::Vector3d& size_m) {
    add_box(surfaces, {0.5 * size_m.y(), at_m, 0.0}, size_m, 0.5 * std::numbers::pi, random);
  });
}

// Tables, crates, bins and a pillar in the middle.
void add_island(std::vector<Surface>& surfaces, double height_m, Random& random) {
  for (int i = 0; i < 4; ++i) {
    const double x_m = kCenterX + kIslandX * (2.0 * i / 3.0 - 1.0);
    const double y_m = kCenterY + random.uniform(-kIslandY, kIslandY);
    if (i == 1) {
      add_cylinder(surfaces, {x_m, y_m, 0.0}, random.uniform(0.15, 0.25), height_m, random);
    } else if (random.chance(0.3)) {
      add_cylinder(surfaces, {x_m, y_m, 0.0}, random.uniform(0.2, 0.35), random.uniform(0.7, 1.4),
                   random);
    } else {
      add_box(surfaces, {x_m, y_m, 0.0},
              {random.uniform(0.5, 1.0), random.uniform(0.4, 0.8), random.uniform(0.7, 1.7)},
              random.uniform(0.0, std::numbers::pi), random);
    }
  }
}

}  // namespace

World make_room(std::uint64_t seed) {
  Random random{seed, 0x4003ULL};
  const double height_m = random.uniform(2.7, 3.3);
  std::vector<Surface> surfaces;
  add_shell(surfaces, {kLengthM, kWidthM, height_m}, random);
  add_wall_furniture(surfaces, random);
  add_island(surfaces, height_m, random);

  const auto path = way_round(random);
  Itinerary itinerary;
  itinerary.rest(1.0);
  itinerary.circle([path](double way_m) { return path->at(way_m); }, random.uniform(0.9, 1.2));
  return {Scene(std::move(surfaces)),
          WalkingMotion(std::move(itinerary), random.uniform(1.15, 1.35), seed)};
}

}  // namespace glint::synth
