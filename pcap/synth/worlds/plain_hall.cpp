// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <numbers>

#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr double kClearOfWayM = 0.8;

FaceLook even(double albedo, double light) {
  return [look = Look{plain(albedo), light}](double, double) { return look; };
}

}  // namespace

World make_plain_hall(WorldBuilder& builder) {
  Random& random = builder.random();
  const Eigen::Vector3d size_m(random.uniform(37.0, 43.0), random.uniform(23.0, 27.0),
                               random.uniform(5.5, 6.5));
  add_shell(builder.surfaces(), size_m,
            {even(0.55, kLampLight), even(0.3, kLampLight), even(0.7, kLampShade)});
  Route route = ring_route(0.5 * size_m.head<2>(), 0.5 * size_m.x() - 5.0, 0.5 * size_m.y() - 4.5,
                           18, 1.0, random);
  route.corner_radius_m = 3.0;
  route.clear_height_m = size_m.z();

  const FaceLook pillar = even(0.5, kLampShade);
  const FaceLook crate = even(0.4, kLampShade);
  for (int things = 7 + random.below(5); things > 0;) {
    const Eigen::Vector3d place_m(random.uniform(1.0, size_m.x() - 1.0),
                                  random.uniform(1.0, size_m.y() - 1.0), 0.0);
    if (distance_to_route_m(route, place_m.head<2>()) < kClearOfWayM + 0.9) continue;
    if (random.chance(0.4)) {
      add_pillar(builder.surfaces(), place_m, random.uniform(0.2, 0.4), size_m.z(), pillar);
    } else {
      add_box(builder.surfaces(), place_m,
              {random.uniform(0.5, 1.4), random.uniform(0.4, 1.1), random.uniform(0.6, 2.2)},
              random.uniform(0.0, std::numbers::pi), crate);
    }
    --things;
  }
  return builder.finish(std::move(route), "walking");
}

}  // namespace glint::synth
