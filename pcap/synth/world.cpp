// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/world.hpp"

#include <array>

#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

constexpr std::array<std::string_view, 2> kNames = {"corridor", "room"};

}  // namespace

std::span<const std::string_view> world_names() { return kNames; }

World make_world(std::string_view name, std::uint64_t seed) {
  if (name == "corridor") return make_corridor(seed);
  if (name == "room") return make_room(seed);
  std::string known;
  for (const std::string_view n : kNames) known += (known.empty() ? "" : ", ") + std::string(n);
  throw OptionError("unknown world '" + std::string(name) + "': choose one of " + known);
}

}  // namespace glint::synth
