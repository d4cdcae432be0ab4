// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <memory>

#include "pcap/synth/paint/albedo_map.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {

/// What the world at large is made of. Albedos are those at 850 nm: leaves are bright, glass dark.
enum class Material {
  kAsphalt,
  kPaving,
  kGrass,
  kEarth,
  kConcrete,
  kPlaster,
  kBrick,
  kRoof,
  kWood,
  kMetal,
  kBark,
  kLeaves,
  kRock,
  kRoadPaint,
  kCloth,
};

/// A picture of the material that repeats without a seam, 1 to 25 m wide: one serves any number of
/// surfaces of any size. Each is different: how bright, how worn, in what pattern.
std::shared_ptr<const AlbedoMap> make_material(Material material, Random& random);

/// The same albedo everywhere.
std::shared_ptr<const AlbedoMap> plain(double albedo);

}  // namespace glint::synth
