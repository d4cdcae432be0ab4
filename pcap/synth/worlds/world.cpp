// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/worlds/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pcap/synth/option_error.hpp"
#include "pcap/synth/worlds/world_makers.hpp"

namespace glint::synth {
namespace {

constexpr std::array<WorldEntry, 14> kEntries = {{
    {"corridor", "80 m straight on, pictures on flat walls: geometry says nothing along it"},
    {"room", "a furnished room, round and round"},
    {"building", "a rectangle of four long corridors that look alike, back to the start"},
    {"floors", "two identical floors and the stairs between them"},
    {"stairs", "three levels of a hall, up by stairs and down by ramps"},
    {"hill", "meadows on slopes, trees and rocks"},
    {"parking", "a car park: rows of cars, painted bays, lamp poles"},
    {"street", "round a block of houses; parked cars, moving cars, people"},
    {"tunnel", "400 m of round tunnel with few marks"},
    {"tunnel-square", "400 m of square tunnel with few marks"},
    {"tunnel-bare", "400 m of round tunnel with no marks at all"},
    {"plain-hall", "a hall without any texture"},
    {"plain-corridor", "80 m straight on without any texture"},
    {"campus", "over 5 km through streets, with places seen again"},
}};
// In the same order.
constexpr std::array<World (*)(WorldBuilder&), kEntries.size()> kMakers = {
    make_corridor,    make_room,       make_building,       make_floors, make_stairs,
    make_hill,        make_parking,    make_street,         make_tunnel, make_square_tunnel,
    make_bare_tunnel, make_plain_hall, make_plain_corridor, make_campus};

}  // namespace

std::span<const WorldEntry> world_list() { return kEntries; }

World make_world(const WorldOptions& options) {
  if (!(options.traffic >= 0.0 && options.traffic <= 10.0)) {
    throw OptionError("traffic must be between 0 and 10 times the usual");
  }
  std::string known;
  for (std::size_t i = 0; i < kEntries.size(); ++i) {
    if (kEntries[i].name == options.name) {
      WorldBuilder builder(options);
      return kMakers[i](builder);
    }
    known += (known.empty() ? "" : ", ") + std::string(kEntries[i].name);
  }
  throw OptionError(fmt::format("unknown world '{}': choose one of {}", options.name, known));
}

}  // namespace glint::synth
