// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>

#include "pcap/synth/albedo_map.hpp"
#include "pcap/synth/random.hpp"

// Whole surfaces of inhabited buildings, each different: width and height in metres, v upwards.
namespace glint::synth {

/// A wall in sections of paint, brick, panels or tiles, with doors, posters, notice boards, signs,
/// pipes, sockets and marks in random places.
std::shared_ptr<const AlbedoMap> decorated_wall(double width_m, double height_m, Random& random);
/// Tiles or boards, with border, markings and stains.
std::shared_ptr<const AlbedoMap> floor_covering(double width_m, double height_m, Random& random);
/// Panels with lamps, vents and detectors.
std::shared_ptr<const AlbedoMap> panel_ceiling(double width_m, double height_m, Random& random);
/// A side of a piece of furniture: shelf, cabinet or crate.
std::shared_ptr<const AlbedoMap> furniture_side(double width_m, double height_m, Random& random);

}  // namespace glint::synth
