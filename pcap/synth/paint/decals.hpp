// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>
#include <span>

#include "pcap/synth/paint/albedo_map.hpp"
#include "pcap/synth/paint/photograph.hpp"
#include "pcap/synth/random.hpp"

// Single things to put in front of a larger surface, width and height in metres. Finely painted but
// small, so that a world can have very many.
namespace glint::synth {

/// Also a photograph, if there are any.
std::shared_ptr<const AlbedoMap> poster(double width_m, double height_m,
                                        std::span<const Photograph> photographs, Random& random);
std::shared_ptr<const AlbedoMap> notice_board(double width_m, double height_m, Random& random);
std::shared_ptr<const AlbedoMap> sign(double width_m, double height_m, Random& random);
std::shared_ptr<const AlbedoMap> house_window(double width_m, double height_m, Random& random);
std::shared_ptr<const AlbedoMap> house_door(double width_m, double height_m, Random& random);
/// Bright, with `letters` letters of the full height.
std::shared_ptr<const AlbedoMap> number_plate(double width_m, double height_m, Random& random);
/// A manhole's cover on asphalt.
std::shared_ptr<const AlbedoMap> manhole(double side_m, Random& random);
/// An arrow on asphalt that points along v.
std::shared_ptr<const AlbedoMap> road_arrow(double width_m, double height_m, Random& random);
/// A car's wheel in its dark arch.
std::shared_ptr<const AlbedoMap> wheel(double side_m, Random& random);
/// A car's flank: paint of this albedo, doors, handles, trim.
std::shared_ptr<const AlbedoMap> car_flank(double width_m, double height_m, double paint,
                                           Random& random);

}  // namespace glint::synth
