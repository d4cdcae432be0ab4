// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/worlds/route_tools.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glint::synth {
namespace {

// Calls visit(from, to) for each leg.
template <class Visit>
void each_leg(const Route& route, Visit&& visit) {
  const std::size_t count = route.points_m.size();
  for (std::size_t i = 0; i + (route.closed ? 0 : 1) < count; ++i) {
    visit(route.points_m[i], route.points_m[(i + 1) % count]);
  }
}

}  // namespace

double length_m(const Route& route) {
  double sum_m = 0.0;
  each_leg(route, [&](const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
    sum_m += (to_m - from_m).norm();
  });
  return sum_m;
}

double distance_to_route_m(const Route& route, const Eigen::Vector2d& place_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  each_leg(route, [&](const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
    const Eigen::Vector2d leg_m = (to_m - from_m).head<2>();
    const Eigen::Vector2d p = place_m - from_m.head<2>();
    const double share = std::clamp(p.dot(leg_m) / leg_m.squaredNorm(), 0.0, 1.0);
    nearest_m = std::min(nearest_m, (p - share * leg_m).norm());
  });
  return nearest_m;
}

std::vector<Eigen::Vector3d> places_along(const Route& route, double step_m) {
  std::vector<Eigen::Vector3d> places_m;
  each_leg(route, [&](const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
    const auto steps = static_cast<int>(std::ceil((to_m - from_m).norm() / step_m));
    for (int i = 0; i < steps; ++i) {
      places_m.emplace_back(from_m + (to_m - from_m) * (static_cast<double>(i) / steps));
    }
  });
  return places_m;
}

void start_anywhere(Route& route, Random& random) {
  auto& points_m = route.points_m;
  std::rotate(points_m.begin(), points_m.begin() + random.below(static_cast<int>(points_m.size())),
              points_m.end());
  if (random.chance(0.5)) std::reverse(points_m.begin(), points_m.end());
}

Route ring_route(const Eigen::Vector2d& middle_m, double half_x_m, double half_y_m, int points,
                 double stray_m, Random& random) {
  Route route;
  route.closed = true;
  const double start_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double direction = random.chance(0.5) ? 1.0 : -1.0;
  for (int i = 0; i < points; ++i) {
    const double angle_rad = start_rad + direction * 2.0 * std::numbers::pi * i / points;
    const double c = std::cos(angle_rad);
    const double s = std::sin(angle_rad);
    // |x/a|^3 + |y/b|^3 = 1.
    const double scale =
        std::pow(std::pow(std::abs(c), 3.0) + std::pow(std::abs(s), 3.0), -1.0 / 3);
    const double out_m = random.uniform(-stray_m, stray_m);
    route.points_m.emplace_back(middle_m.x() + (half_x_m * scale + out_m) * c,
                                middle_m.y() + (half_y_m * scale + out_m) * s, 0.0);
  }
  return route;
}

Route straying_route(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double step_m,
                     double stray_m, Random& random) {
  Route route;
  const Eigen::Vector3d way_m = to_m - from_m;
  const Eigen::Vector3d sideways = way_m.cross(Eigen::Vector3d::UnitZ()).normalized();
  const auto steps = static_cast<int>(std::round(way_m.norm() / step_m));
  for (int i = 0; i <= steps; ++i) {
    route.points_m.emplace_back(from_m + way_m * (static_cast<double>(i) / steps) +
                                random.uniform(-stray_m, stray_m) * sideways);
  }
  return route;
}

}  // namespace glint::synth
