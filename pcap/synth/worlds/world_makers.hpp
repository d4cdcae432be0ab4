// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "pcap/synth/worlds/world_builder.hpp"

// One function a world; world.cpp says what each is.
namespace glint::synth {

World make_corridor(WorldBuilder& builder);
World make_room(WorldBuilder& builder);
World make_building(WorldBuilder& builder);
World make_floors(WorldBuilder& builder);
World make_stairs(WorldBuilder& builder);
World make_hill(WorldBuilder& builder);
World make_parking(WorldBuilder& builder);
World make_street(WorldBuilder& builder);
World make_tunnel(WorldBuilder& builder);
World make_square_tunnel(WorldBuilder& builder);
World make_bare_tunnel(WorldBuilder& builder);
World make_plain_hall(WorldBuilder& builder);
World make_plain_corridor(WorldBuilder& builder);
World make_campus(WorldBuilder& builder);

}  // namespace glint::synth
