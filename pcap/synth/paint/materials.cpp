// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/materials.hpp"

#include <cmath>
#include <numbers>

#include "pcap/synth/paint/coats.hpp"
#include "pcap/synth/paint/pictures.hpp"

namespace glint::synth {
namespace {

Canvas blank(double side_m, double texel_m, double albedo) {
  return Canvas(side_m, side_m, texel_m, albedo, Edges::kRepeat);
}

// Calls draw(u_m, v_m) for random places.
template <class Draw>
void scatter(const Canvas& canvas, int count, Random& random, Draw&& draw) {
  for (int i = 0; i < count; ++i) {
    const double u_m = random.uniform(0.0, canvas.whole().width_m);
    draw(u_m, random.uniform(0.0, canvas.whole().height_m));
  }
}

void add_cracks(Canvas& canvas, int count, double thickness_m, double albedo, Random& random) {
  scatter(canvas, count, random, [&](double u, double v) {
    const double heading_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
    draw_crack(canvas, u, v, heading_rad, random.uniform(1.0, 5.0), thickness_m, albedo, random);
  });
}

// Where rain has run down.
void add_streaks(Canvas& canvas, int count, Random& random) {
  scatter(canvas, count, random, [&](double u, double v) {
    const Area streak{u, v, random.uniform(0.04, 0.2), random.uniform(0.5, 2.5)};
    canvas.blotch(streak, 4.0, random.uniform(0.1, 0.4), random.next());
  });
}

Canvas asphalt(Random& random) {
  const double albedo = random.uniform(0.13, 0.20);
  Canvas canvas = blank(25.6, 0.025, albedo);
  // Mended places, sealed cracks, open cracks, oil.
  scatter(canvas, 9, random, [&](double u, double v) {
    canvas.fill({u, v, random.uniform(0.6, 4.0), random.uniform(0.6, 2.0)},
                albedo * random.uniform(0.6, 1.35));
  });
  add_cracks(canvas, 14, 0.06, 0.045, random);
  add_cracks(canvas, 24, 0.025, 0.07, random);
  scatter(canvas, 40, random,
          [&](double u, double v) { draw_stain(canvas, u, v, random.uniform(0.2, 0.9), random); });
  roughen(canvas, canvas.whole(), {{6.4, 0.12}, {1.6, 0.12}, {0.4, 0.10}, {0.1, 0.12}}, random);
  return canvas;
}

Canvas paving(Random& random) {
  const double albedo = random.uniform(0.25, 0.45);
  Canvas canvas = blank(10.24, 0.02, albedo);
  const Tiling tiling{.width_m = random.chance(0.5) ? 0.32 : 0.64,
                      .height_m = 0.32,
                      .joint_m = 0.02,
                      .bricks = random.chance(0.5),
                      .contrast = 0.08,
                      .albedo = albedo,
                      .joint_albedo = 0.5 * albedo};
  draw_tiles(canvas, canvas.whole(), tiling, random);
  scatter(canvas, 60, random, [&](double u, double v) {
    canvas.disc(u, v, random.uniform(0.02, 0.05), random.chance(0.7) ? 0.1 : 0.6);
  });
  roughen(canvas, canvas.whole(), {{3.0, 0.12}, {0.7, 0.12}, {0.15, 0.1}}, random);
  return canvas;
}

Canvas grass(Random& random) {
  Canvas canvas = blank(25.6, 0.025, random.uniform(0.32, 0.42));
  scatter(canvas, 350, random, [&](double u, double v) {
    canvas.disc(u, v, random.uniform(0.06, 0.3), random.uniform(0.22, 0.6));
  });
  scatter(canvas, 12, random, [&](double u, double v) {
    canvas.disc(u, v, random.uniform(0.3, 0.9), random.uniform(0.15, 0.22));
  });
  roughen(canvas, canvas.whole(), {{6.4, 0.2}, {1.6, 0.22}, {0.4, 0.25}, {0.1, 0.25}}, random);
  return canvas;
}

Canvas earth(Random& random) {
  Canvas canvas = blank(12.8, 0.025, random.uniform(0.18, 0.28));
  scatter(canvas, 200, random, [&](double u, double v) {
    canvas.disc(u, v, random.uniform(0.03, 0.12), random.uniform(0.1, 0.45));
  });
  roughen(canvas, canvas.whole(), {{4.0, 0.2}, {1.0, 0.2}, {0.25, 0.2}, {0.08, 0.2}}, random);
  return canvas;
}

Canvas concrete(Random& random) {
  const double albedo = random.uniform(0.3, 0.45);
  Canvas canvas = blank(10.24, 0.02, albedo);
  const Tiling boards{.width_m = 2.56,
                      .height_m = 1.28,
                      .joint_m = 0.03,
                      .contrast = 0.06,
                      .albedo = albedo,
                      .joint_albedo = 0.6 * albedo};
  draw_tiles(canvas, canvas.whole(), boards, random);
  for (double v = 0.32; v < canvas.whole().height_m; v += 0.64) {
    for (double u = 0.64; u < canvas.whole().width_m; u += 1.28) canvas.disc(u, v, 0.03, 0.1);
  }
  add_cracks(canvas, 4, 0.02, 0.15, random);
  add_streaks(canvas, 40, random);
  roughen(canvas, canvas.whole(), {{3.4, 0.15}, {0.9, 0.15}, {0.25, 0.1}, {0.07, 0.08}}, random);
  return canvas;
}

Canvas plaster(Random& random) {
  const double albedo = random.uniform(0.4, 0.75);
  Canvas canvas = blank(10.24, 0.02, albedo);
  add_cracks(canvas, 5, 0.02, 0.6 * albedo, random);
  add_streaks(canvas, 50, random);
  roughen(canvas, canvas.whole(), {{3.4, 0.10}, {0.9, 0.08}, {0.2, 0.06}, {0.06, 0.06}}, random);
  return canvas;
}

Canvas brick(Random& random) {
  const double albedo = random.uniform(0.22, 0.42);
  Canvas canvas = blank(5.12, 0.01, albedo);
  const Tiling bricks{.width_m = 0.256,
                      .height_m = 0.08,
                      .joint_m = 0.015,
                      .bricks = true,
                      .contrast = 0.16,
                      .albedo = albedo,
                      .joint_albedo = random.chance(0.6) ? 1.5 * albedo : 0.5 * albedo};
  draw_tiles(canvas, canvas.whole(), bricks, random);
  roughen(canvas, canvas.whole(), {{2.5, 0.15}, {0.6, 0.12}, {0.05, 0.1}}, random);
  return canvas;
}

Canvas roof(Random& random) {
  const double albedo = random.uniform(0.2, 0.4);
  Canvas canvas = blank(5.12, 0.02, albedo);
  const Tiling tiles{.width_m = 0.32,
                     .height_m = 0.32,
                     .joint_m = 0.04,
                     .contrast = 0.12,
                     .albedo = albedo,
                     .joint_albedo = 0.4 * albedo};
  draw_tiles(canvas, canvas.whole(), tiles, random);
  roughen(canvas, canvas.whole(), {{1.7, 0.2}, {0.4, 0.15}}, random);
  return canvas;
}

Canvas wood(Random& random) {
  const double albedo = random.uniform(0.25, 0.55);
  Canvas canvas = blank(2.56, 0.01, albedo);
  const Tiling boards{.width_m = 0.16,
                      .height_m = 2.56,
                      .joint_m = 0.02,
                      .contrast = 0.15,
                      .albedo = albedo,
                      .joint_albedo = 0.05};
  draw_tiles(canvas, canvas.whole(), boards, random);
  scatter(canvas, 30, random, [&](double u, double v) { canvas.disc(u, v, 0.025, 0.4 * albedo); });
  roughen(canvas, canvas.whole(), {{0.8, 0.15}, {0.1, 0.12}}, random);
  return canvas;
}

Canvas metal(Random& random) {
  Canvas canvas = blank(2.56, 0.02, random.uniform(0.2, 0.6));
  scatter(canvas, 12, random, [&](double u, double v) {
    canvas.disc(u, v, random.uniform(0.02, 0.08), random.uniform(0.08, 0.2));
  });
  roughen(canvas, canvas.whole(), {{0.8, 0.12}, {0.15, 0.08}}, random);
  return canvas;
}

Canvas bark(Random& random) {
  const double albedo = random.uniform(0.2, 0.35);
  Canvas canvas = blank(2.56, 0.01, albedo);
  scatter(canvas, 260, random, [&](double u, double v) {
    const double heading_rad = 0.5 * std::numbers::pi + random.uniform(-0.2, 0.2);
    draw_crack(canvas, u, v, heading_rad, random.uniform(0.2, 0.8), random.uniform(0.015, 0.035),
               albedo * (random.chance(0.7) ? 0.4 : 1.5), random);
  });
  scatter(canvas, 10, random, [&](double u, double v) {
    canvas.disc(u, v, random.uniform(0.03, 0.1), random.uniform(0.35, 0.6));
  });
  roughen(canvas, canvas.whole(), {{0.8, 0.2}, {0.2, 0.2}}, random);
  return canvas;
}

Canvas leaves(Random& random) {
  Canvas canvas = blank(2.56, 0.02, random.uniform(0.35, 0.5));
  scatter(canvas, 500, random, [&](double u, double v) {
    canvas.disc(u, v, random.uniform(0.03, 0.08), random.uniform(0.15, 0.6));
  });
  roughen(canvas, canvas.whole(), {{0.6, 0.25}, {0.15, 0.25}}, random);
  return canvas;
}

Canvas rock(Random& random) {
  const double albedo = random.uniform(0.22, 0.4);
  Canvas canvas = blank(5.12, 0.02, albedo);
  add_cracks(canvas, 20, 0.03, 0.5 * albedo, random);
  scatter(canvas, 60, random, [&](double u, double v) {
    canvas.disc(u, v, random.uniform(0.03, 0.15), albedo * random.uniform(0.6, 1.6));
  });
  roughen(canvas, canvas.whole(), {{1.3, 0.25}, {0.3, 0.25}, {0.08, 0.15}}, random);
  return canvas;
}

Canvas road_paint(Random& random) {
  Canvas canvas = blank(5.12, 0.02, random.uniform(0.5, 0.7));
  scatter(canvas, 150, random,
          [&](double u, double v) { canvas.disc(u, v, random.uniform(0.02, 0.08), 0.2); });
  roughen(canvas, canvas.whole(), {{1.3, 0.15}, {0.2, 0.15}}, random);
  return canvas;
}

Canvas cloth(Random& random) {
  Canvas canvas = blank(0.64, 0.01, random.uniform(0.1, 0.65));
  if (random.chance(0.4)) {
    const double stripe = random.uniform(0.05, 0.7);
    for (double v = 0.0; v < 0.64; v += 0.16) canvas.fill({0.0, v, 0.64, 0.06}, stripe);
  }
  roughen(canvas, canvas.whole(), {{0.3, 0.2}, {0.08, 0.12}}, random);
  return canvas;
}

Canvas even(double albedo) { return Canvas(0.02, 0.02, 0.01, albedo); }

Canvas canvas_of(Material material, Random& random) {
  switch (material) {
    case Material::kAsphalt:
      return asphalt(random);
    case Material::kPaving:
      return paving(random);
    case Material::kGrass:
      return grass(random);
    case Material::kEarth:
      return earth(random);
    case Material::kConcrete:
      return concrete(random);
    case Material::kPlaster:
      return plaster(random);
    case Material::kBrick:
      return brick(random);
    case Material::kRoof:
      return roof(random);
    case Material::kWood:
      return wood(random);
    case Material::kMetal:
      return metal(random);
    case Material::kBark:
      return bark(random);
    case Material::kLeaves:
      return leaves(random);
    case Material::kRock:
      return rock(random);
    case Material::kRoadPaint:
      return road_paint(random);
    case Material::kCloth:
      return cloth(random);
  }
  return even(0.3);
}

}  // namespace

std::shared_ptr<const AlbedoMap> make_material(Material material, Random& random) {
  return std::make_shared<const AlbedoMap>(canvas_of(material, random));
}

std::shared_ptr<const AlbedoMap> plain(double albedo) {
  return std::make_shared<const AlbedoMap>(even(albedo));
}

}  // namespace glint::synth
