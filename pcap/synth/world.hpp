// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "pcap/synth/motion.hpp"
#include "pcap/synth/scene.hpp"

namespace glint::synth {

/// A place and a way through it. Layout and motion are random by seed.
struct World {
  Scene scene;
  WalkingMotion motion;
};

/// Names that make_world() knows.
std::span<const std::string_view> world_names();

/// @throws OptionError that lists the known names.
World make_world(std::string_view name, std::uint64_t seed);

/// A straight corridor, 80 m long: flat walls that carry only pictures, so that geometry says
/// nothing along the axis while both ends are far.
World make_corridor(std::uint64_t seed);
/// A furnished room, 12 m by 9 m, and a closed way round its middle.
World make_room(std::uint64_t seed);

}  // namespace glint::synth
