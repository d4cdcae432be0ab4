// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>
#include <span>

#include "pcap/synth/paint/albedo_map.hpp"
#include "pcap/synth/paint/photograph.hpp"
#include "pcap/synth/random.hpp"

// Whole surfaces of inhabited buildings, each different: width and height in metres, v upwards.
namespace glint::synth {

/// A wall in sections of paint, brick, panels or tiles, with doors, posters, notice boards, signs,
/// pipes, sockets and marks in random places; photographs among the posters if there are any.
std::shared_ptr<const AlbedoMap> decorated_wall(double width_m, double height_m,
                                                std::span<const Photograph> photographs,
                                                Random& random);
/// A wall of one make from end to end, with doors at even distances and nothing else on it but what
/// comes with a building: skirting, sockets, wear.
std::shared_ptr<const AlbedoMap> office_wall(double width_m, double height_m, Random& random);
/// Tiles of one kind, worn: nothing tells one place from another but the wear.
std::shared_ptr<const AlbedoMap> office_floor(double width_m, double height_m, Random& random);
/// Tiles or boards, with border, markings and stains.
std::shared_ptr<const AlbedoMap> floor_covering(double width_m, double height_m, Random& random);
/// Panels with lamps, vents and detectors.
std::shared_ptr<const AlbedoMap> panel_ceiling(double width_m, double height_m, Random& random);
/// A side of a piece of furniture: shelf, cabinet or crate.
std::shared_ptr<const AlbedoMap> furniture_side(double width_m, double height_m, Random& random);

}  // namespace glint::synth
