// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>

#include "pcap/synth/random.hpp"
#include "pcap/synth/texture.hpp"

namespace glint::synth {

/// A wall of an inhabited building: paint with blotches, doors, posters, notices, signs and marks
/// in random places. `width_m` by `height_m`, v upwards from the floor.
std::shared_ptr<const Texture> decorated_wall(double width_m, double height_m, Random& random);
/// A floor or ceiling of tiles; floors also carry marks and stains.
std::shared_ptr<const Texture> tiled_floor(double width_m, double height_m, Random& random);
std::shared_ptr<const Texture> tiled_ceiling(double width_m, double height_m, Random& random);
/// Furniture: plain panels with handles, labels and shelves of things.
std::shared_ptr<const Texture> furniture(Random& random);

}  // namespace glint::synth
