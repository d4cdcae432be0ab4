// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/decoration.hpp"

namespace glint::synth {
namespace {

std::uint64_t new_seed(Random& random) {
  return static_cast<std::uint64_t>(random.uniform() * 9007199254740992.0);
}

// Puts `count` decals of random size and place, leaving out those that would lie on another one.
void scatter(Texture& texture, Random& random, int count, double width_m, double height_m,
             double low_m, double smallest_m, double largest_m) {
  for (int i = 0; i < count; ++i) {
    Decal decal;
    decal.width_m = random.uniform(smallest_m, largest_m);
    decal.height_m = decal.width_m * random.uniform(0.6, 1.5);
    decal.u_m = random.uniform(0.0, width_m - decal.width_m);
    decal.v_m = random.uniform(low_m, height_m - decal.height_m);
    decal.pattern = static_cast<Decal::Pattern>(static_cast<int>(random.uniform(0.0, 4.0)));
    decal.bright = random.uniform(0.6, 0.95);
    decal.dark = random.uniform(0.04, 0.35);
    decal.seed = new_seed(random);
    if (decal.v_m >= low_m && !texture.occupied(decal, 0.05)) texture.add(decal);
  }
}

void add_doors(Texture& texture, Random& random, double width_m) {
  double u_m = random.uniform(1.0, 4.0);
  while (u_m + 1.1 < width_m) {
    const double leaf = random.uniform(0.1, 0.8);
    // Frame, leaf, handle plate and name plate.
    texture.add({u_m, 0.0, 1.1, 2.15, Decal::Pattern::kPlain, 0.9, random.uniform(0.15, 0.9), 0});
    texture.add({u_m + 0.08, 0.0, 0.94, 2.07, Decal::Pattern::kPlain, 0.9, leaf, 0});
    texture.add(
        {u_m + 0.14, 0.95, 0.07, 0.25, Decal::Pattern::kPlain, 0.9, leaf > 0.4 ? 0.1 : 0.9, 0});
    if (random.uniform() < 0.7) {
      texture.add({u_m + 0.35, 1.5, 0.35, 0.2, Decal::Pattern::kText, 0.9, 0.1, new_seed(random)});
    }
    u_m += random.uniform(2.5, 9.0);
  }
}

}  // namespace

std::shared_ptr<const Texture> decorated_wall(double width_m, double height_m, Random& random) {
  Texture::Base base;
  base.albedo = random.uniform(0.35, 0.7);
  base.blotch_contrast = random.uniform(0.10, 0.25);
  base.seed = new_seed(random);
  if (random.uniform() < 0.4) {
    base.tile_width_m = 0.24;
    base.tile_height_m = 0.08;
    base.bricks = true;
  }
  auto texture = std::make_shared<Texture>(base);
  // A skirting board along the floor.
  texture->add(
      {0.0, 0.0, width_m, 0.10, Decal::Pattern::kPlain, 0.9, random.uniform(0.05, 0.3), 0});
  add_doors(*texture, random, width_m);
  const int per_10_m = static_cast<int>(width_m / 10.0) + 1;
  scatter(*texture, random, 10 * per_10_m, width_m, height_m, 0.7, 0.4, 1.2);   // posters
  scatter(*texture, random, 18 * per_10_m, width_m, height_m, 0.3, 0.12, 0.4);  // notices, switches
  return texture;
}

std::shared_ptr<const Texture> tiled_floor(double width_m, double height_m, Random& random) {
  Texture::Base base;
  base.albedo = random.uniform(0.25, 0.5);
  base.blotch_contrast = 0.2;
  base.tile_width_m = base.tile_height_m = random.uniform(0.3, 0.6);
  base.seed = new_seed(random);
  auto texture = std::make_shared<Texture>(base);
  const int marks = static_cast<int>(width_m * height_m / 6.0);
  scatter(*texture, random, marks, width_m, height_m, 0.0, 0.15, 0.7);
  return texture;
}

std::shared_ptr<const Texture> tiled_ceiling(double width_m, double height_m, Random& random) {
  Texture::Base base;
  base.albedo = random.uniform(0.6, 0.8);
  base.blotch_contrast = 0.05;
  base.tile_width_m = base.tile_height_m = 0.625;
  base.tile_contrast = 0.05;
  base.seed = new_seed(random);
  auto texture = std::make_shared<Texture>(base);
  // Lamps, vents, detectors.
  const int fittings = static_cast<int>(width_m * height_m / 5.0);
  scatter(*texture, random, fittings, width_m, height_m, 0.0, 0.15, 0.6);
  return texture;
}

std::shared_ptr<const Texture> furniture(Random& random) {
  Texture::Base base;
  base.albedo = random.uniform(0.15, 0.8);
  base.blotch_contrast = 0.15;
  base.tile_width_m = random.uniform(0.4, 0.7);
  base.tile_height_m = random.uniform(0.3, 0.6);
  base.tile_contrast = random.uniform(0.1, 0.4);
  base.seed = new_seed(random);
  auto texture = std::make_shared<Texture>(base);
  scatter(*texture, random, 12, 2.0, 1.8, 0.0, 0.08, 0.35);
  return texture;
}

}  // namespace glint::synth
