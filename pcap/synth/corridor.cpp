// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/decoration.hpp"
#include "pcap/synth/world.hpp"

namespace glint::synth {
namespace {

constexpr double kLength_m = 80.0;
constexpr double kEndMargin_m = 5.0;  // Nearer to its ends nobody walks.

}  // namespace

World make_corridor(std::uint64_t seed) {
  Random random{seed, 0xC0441D04ULL};
  const double width_m = random.uniform(2.2, 3.0);
  const double height_m = random.uniform(2.5, 3.0);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d right(0.0, -0.5 * width_m, 0.0);
  const Eigen::Vector3d left(0.0, 0.5 * width_m, 0.0);

  Scene scene;
  scene.add({right, x, z, kLength_m, height_m, decorated_wall(kLength_m, height_m, random)});
  scene.add({left, x, z, kLength_m, height_m, decorated_wall(kLength_m, height_m, random)});
  scene.add({right, y, z, width_m, height_m, decorated_wall(width_m, height_m, random)});
  scene.add(
      {right + kLength_m * x, y, z, width_m, height_m, decorated_wall(width_m, height_m, random)});
  scene.add({right, x, y, kLength_m, width_m, tiled_floor(kLength_m, width_m, random)});
  scene.add(
      {right + height_m * z, x, y, kLength_m, width_m, tiled_ceiling(kLength_m, width_m, random)});

  const double way_m = kLength_m - 2.0 * kEndMargin_m;
  const double speed_mps = random.uniform(1.1, 1.3);
  const double aside_m = random.uniform(-0.25, 0.25);
  Itinerary itinerary;
  itinerary.rest(1.0);
  itinerary.follow(
      [=](double s) {
        return PathPoint{kEndMargin_m + s, aside_m, 0.0};
      },
      way_m, speed_mps);
  itinerary.turn(M_PI, 4.0);
  itinerary.follow(
      [=](double s) {
        return PathPoint{kEndMargin_m + way_m - s, aside_m, M_PI};
      },
      way_m, speed_mps);
  itinerary.turn(M_PI, 4.0);
  return {std::move(scene), WalkingMotion(std::move(itinerary), 1.4, seed)};
}

}  // namespace glint::synth
