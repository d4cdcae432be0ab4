// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <memory>
#include <numbers>

#include "pcap/synth/shell.hpp"
#include "pcap/synth/spline_path.hpp"
#include "pcap/synth/world.hpp"

namespace glint::synth {
namespace {

constexpr double kLengthM = 80.0;
// Nearer to its ends nobody walks.
constexpr double kEndMarginM = 5.0;
constexpr double kPointSpacingM = 2.5;
constexpr double kTurnS = 4.5;

// From one end to the other, straying from the middle by a little.
std::shared_ptr<const SplinePath> way_along(double middle_m, Random& random) {
  // A quintic spline of evenly spaced points begins at its third one.
  constexpr int kSpare = 2;
  const int steps = static_cast<int>((kLengthM - 2.0 * kEndMarginM) / kPointSpacingM);
  std::vector<Eigen::Vector2d> points_m;
  for (int i = -kSpare; i <= steps + kSpare; ++i) {
    points_m.emplace_back(kEndMarginM + i * kPointSpacingM, middle_m + random.uniform(-0.3, 0.3));
  }
  return std::make_shared<const SplinePath>(std::move(points_m), false);
}

}  // namespace

World make_corridor(std::uint64_t seed) {
  Random random{seed, 0xC0441D04ULL};
  const Eigen::Vector3d size_m(kLengthM, random.uniform(2.3, 2.7), random.uniform(2.6, 2.8));
  std::vector<Surface> surfaces;
  add_shell(surfaces, size_m, random);

  const auto path = way_along(0.5 * size_m.y(), random);
  const double speed_mps = random.uniform(1.15, 1.25);
  Itinerary itinerary;
  itinerary.rest(1.0);
  itinerary.follow([path](double way_m) { return path->at(way_m); }, path->length_m(), speed_mps);
  itinerary.turn(std::numbers::pi, kTurnS);
  itinerary.follow(
      [path](double way_m) {
        PathPoint point = path->at(path->length_m() - way_m);
        point.heading_rad += std::numbers::pi;
        return point;
      },
      path->length_m(), speed_mps);
  itinerary.turn(std::numbers::pi, kTurnS);
  return {Scene(std::move(surfaces)),
          WalkingMotion(std::move(itinerary), random.uniform(1.15, 1.35), seed)};
}

}  // namespace glint::synth
