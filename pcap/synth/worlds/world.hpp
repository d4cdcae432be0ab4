// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcap/synth/motion/route.hpp"
#include "pcap/synth/paint/photograph.hpp"
#include "pcap/synth/scene/scene.hpp"

namespace glint::synth {

/// A place and a way through it. Layout, looks and way are random by seed.
struct World {
  Scene scene;
  Route route;
  std::string motion = "walking";  ///< How one usually moves there.
};

struct WorldOptions {
  std::string name = "corridor";  ///< One of world_names().
  std::uint64_t seed = 1;
  std::vector<Photograph> photographs;  ///< To hang up where posters hang.
  double traffic = 1.0;                 ///< Times as many moving cars and people as usual.
};

/// A world's name and one line that says what it is.
struct WorldEntry {
  std::string_view name;
  std::string_view what;
};
/// All worlds that make_world() knows.
std::span<const WorldEntry> world_list();

/// @throws OptionError that lists the known names, or tells the traffic possible.
World make_world(const WorldOptions& options);

}  // namespace glint::synth
