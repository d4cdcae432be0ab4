// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/worlds/route_tools.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr double kLengthM = 80.0;
// Nearer to its ends nobody walks.
constexpr double kEndMarginM = 5.0;

World corridor(WorldBuilder& builder, const ShellLook& look) {
  Random& random = builder.random();
  const Eigen::Vector3d size_m(kLengthM, random.uniform(2.3, 2.7), random.uniform(2.6, 2.8));
  add_shell(builder.surfaces(), size_m, look);
  const double middle_m = 0.5 * size_m.y();
  Route route = straying_route({kEndMarginM, middle_m, 0.0},
                               {kLengthM - kEndMarginM, middle_m, 0.0}, 5.0, 0.3, random);
  route.corner_radius_m = 10.0;
  route.clear_height_m = size_m.z();
  return builder.finish(std::move(route), "walking");
}

}  // namespace

World make_corridor(WorldBuilder& builder) { return corridor(builder, builder.decorated_shell()); }

World make_plain_corridor(WorldBuilder& builder) {
  const auto face = [](double albedo) {
    return [look = Look{plain(albedo), kLampLight}](double, double) { return look; };
  };
  return corridor(builder, {face(builder.random().uniform(0.45, 0.65)), face(0.3), face(0.7)});
}

}  // namespace glint::synth
