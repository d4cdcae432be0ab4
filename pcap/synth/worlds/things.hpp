// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "pcap/synth/worlds/world_builder.hpp"

// Things that worlds are furnished with, each in its own frame: the origin on the ground, z up,
// x ahead if it has a front. Every call makes another one.
namespace glint::synth {

/// A parked or driving car or van: 3.8 to 5.2 m long, at most 1.9 m wide.
BodyPtr car(WorldBuilder& builder);
/// A trunk of bark and a crown of leaves with gaps, that begins `clear_m` above the ground.
BodyPtr tree(WorldBuilder& builder, double clear_m = 3.2);
/// 0.4 to 1.5 m across, sunk into the ground.
BodyPtr rock(WorldBuilder& builder);
/// Somebody on the way.
BodyPtr person(WorldBuilder& builder);
/// With an arm and a lamp, 5 to 7 m high.
BodyPtr lamp_pole(WorldBuilder& builder);
/// A traffic sign on its pole, to be read by who comes along -x.
BodyPtr sign_pole(WorldBuilder& builder);
/// A house whose front looks along -y: windows, a door, now and then a shop, balconies, a roof.
/// `width_m` along x, `depth_m` along y.
BodyPtr house(WorldBuilder& builder, double width_m, double depth_m, int storeys);

/// So many of them.
template <class Make>
Variants variants(int count, Make&& make) {
  Variants all;
  for (int i = 0; i < count; ++i) all.push_back(make());
  return all;
}

}  // namespace glint::synth
