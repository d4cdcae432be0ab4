// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/decoration.hpp"

#include <algorithm>
#include <cmath>

#include "pcap/synth/paint/coats.hpp"
#include "pcap/synth/paint/pictures.hpp"

namespace glint::synth {
namespace {

// What beams of some millimetres can tell apart at close range.
constexpr double kTexelM = 0.01;

Tiling tiles_of(double width_m, double height_m, double contrast, Random& random) {
  Tiling tiling;
  tiling.width_m = width_m;
  tiling.height_m = height_m;
  tiling.contrast = contrast;
  tiling.albedo = random.uniform(0.25, 0.6);
  tiling.joint_albedo = tiling.albedo * (random.chance(0.5) ? 0.55 : 1.5);
  return tiling;
}

Tiling bricks_of(double width_m, double height_m, double contrast, Random& random) {
  Tiling tiling = tiles_of(width_m, height_m, contrast, random);
  tiling.bricks = true;
  tiling.joint_m = 0.015;
  return tiling;
}

// One section of a wall's background.
void draw_section(Canvas& canvas, const Area& area, Random& random) {
  const double kind = random.uniform();
  if (kind < 0.25) {
    draw_tiles(canvas, area, bricks_of(0.25, 0.083, 0.13, random), random);
  } else if (kind < 0.35) {
    draw_tiles(canvas, area, tiles_of(0.3, 0.3, 0.05, random), random);
  } else if (kind < 0.5) {
    const double panel_m = random.uniform(0.6, 1.2);
    draw_tiles(canvas, area, tiles_of(panel_m, area.height_m, 0.10, random), random);
  } else {
    canvas.fill(area, random.uniform(0.35, 0.75));
    const double dado_m = random.uniform(0.8, 1.3);
    if (random.chance(0.5)) {
      canvas.fill({area.u_m, area.v_m, area.width_m, dado_m}, random.uniform(0.2, 0.6));
      canvas.fill({area.u_m, area.v_m + dado_m, area.width_m, 0.06}, random.uniform(0.1, 0.8));
    }
  }
  weather(canvas, area, random.uniform(0.06, 0.16), random);
}

// Small things between the large ones: sockets, switches, stickers, scratches, words.
void draw_clutter(Canvas& canvas, const Area& area, Random& random) {
  const double kind = random.uniform();
  const double u = area.u_m + random.uniform(0.0, area.width_m);
  const double v = area.v_m + random.uniform(0.25, 0.9) * area.height_m;
  const double albedo = random.chance(0.5) ? random.uniform(0.03, 0.2) : random.uniform(0.7, 0.95);
  if (kind < 0.3) {
    canvas.fill({u, v, random.uniform(0.08, 0.16), random.uniform(0.08, 0.16)}, albedo);
  } else if (kind < 0.55) {
    draw_sign(canvas, {u, v, random.uniform(0.15, 0.35), random.uniform(0.12, 0.3)}, random);
  } else if (kind < 0.75) {
    draw_text(canvas, u, v, random.uniform(0.08, 0.25), 2 + random.below(6), albedo, random);
  } else {
    canvas.stroke(u, v, u + random.uniform(-0.5, 0.5), v + random.uniform(-0.3, 0.3),
                  random.uniform(0.015, 0.04), albedo);
  }
}

// The next large thing on a wall, from `u_m` to the right. Returns where it ends.
double draw_fixture(Canvas& canvas, double u_m, double height_m,
                    std::span<const Photograph> photographs, Random& random) {
  const double kind = random.uniform();
  if (kind < 0.30) {
    const double width_m = random.uniform(0.9, 1.25);
    draw_door(canvas, {u_m, 0.0, width_m, std::min(2.1, height_m)}, random);
    return u_m + width_m;
  }
  if (kind < 0.65) {
    const double width_m = random.uniform(0.4, 1.0);
    draw_poster(canvas,
                {u_m, random.uniform(0.7, 1.1), width_m,
                 std::min(width_m * random.uniform(0.8, 1.5), height_m - 1.2)},
                photographs, random);
    return u_m + width_m;
  }
  if (kind < 0.78) {
    const double width_m = random.uniform(1.0, 2.0);
    draw_notice_board(canvas, {u_m, random.uniform(0.8, 1.0), width_m, 1.0}, random);
    return u_m + width_m;
  }
  if (kind < 0.88) {
    // A pipe or duct, painted on.
    const double width_m = random.uniform(0.06, 0.25);
    canvas.fill({u_m, 0.0, width_m, height_m}, random.uniform(0.05, 0.85));
    canvas.fill({u_m, random.uniform(0.5, 2.0), width_m, 0.08}, random.uniform(0.05, 0.9));
    return u_m + width_m;
  }
  const double size_m = random.uniform(0.25, 0.5);
  draw_sign(canvas, {u_m, random.uniform(1.2, 1.7), size_m, size_m}, random);
  return u_m + size_m;
}

}  // namespace

std::shared_ptr<const AlbedoMap> decorated_wall(double width_m, double height_m,
                                                std::span<const Photograph> photographs,
                                                Random& random) {
  Canvas canvas(width_m, height_m, kTexelM, 0.5);
  for (double u = 0.0; u < width_m;) {
    const double section_m = random.uniform(4.0, 14.0);
    draw_section(canvas, {u, 0.0, std::min(section_m, width_m - u), height_m}, random);
    u += section_m;
  }
  const double skirting = random.uniform(0.05, 0.3);
  canvas.fill({0.0, 0.0, width_m, 0.1}, skirting);
  for (double u = random.uniform(0.2, 1.5); u < width_m;) {
    const double end = draw_fixture(canvas, u, height_m, photographs, random);
    const double gap_m = random.uniform(0.3, 2.2);
    for (double at = end; at + 0.5 < end + gap_m; at += 0.5) {
      if (random.chance(0.6)) draw_clutter(canvas, {at, 0.0, 0.5, height_m}, random);
    }
    u = end + gap_m;
  }
  return std::make_shared<const AlbedoMap>(canvas);
}

std::shared_ptr<const AlbedoMap> office_wall(double width_m, double height_m, Random& random) {
  Canvas canvas(width_m, height_m, kTexelM, 0.5);
  draw_section(canvas, canvas.whole(), random);
  canvas.fill({0.0, 0.0, width_m, 0.1}, random.uniform(0.05, 0.3));
  const double rhythm_m = random.uniform(3.2, 5.5);
  const double door_m = random.uniform(0.95, 1.2);
  const Random door_look = random;
  for (double u = random.uniform(0.8, 2.0); u + door_m < width_m; u += rhythm_m) {
    Random same_again = door_look;
    draw_door(canvas, {u, 0.0, door_m, std::min(2.1, height_m)}, same_again);
    canvas.fill({u + door_m + 0.15, 1.05, 0.09, 0.09}, 0.85);
    canvas.fill({u + door_m + 0.9, 0.3, 0.09, 0.09}, 0.85);
  }
  return std::make_shared<const AlbedoMap>(canvas);
}

std::shared_ptr<const AlbedoMap> office_floor(double width_m, double height_m, Random& random) {
  Canvas canvas(width_m, height_m, kTexelM, 0.4);
  const double tile_m = random.uniform(0.3, 0.6);
  draw_tiles(canvas, canvas.whole(), tiles_of(tile_m, tile_m, 0.08, random), random);
  weather(canvas, canvas.whole(), 0.14, random);
  return std::make_shared<const AlbedoMap>(canvas);
}

std::shared_ptr<const AlbedoMap> floor_covering(double width_m, double height_m, Random& random) {
  Canvas canvas(width_m, height_m, kTexelM, 0.4);
  const double tile_m = random.uniform(0.3, 0.6);
  if (random.chance(0.7)) {
    draw_tiles(canvas, canvas.whole(), tiles_of(tile_m, tile_m, 0.12, random), random);
  } else {
    draw_tiles(canvas, canvas.whole(), bricks_of(1.2, 0.14, 0.15, random), random);
  }
  weather(canvas, canvas.whole(), 0.12, random);
  canvas.frame(canvas.whole(), random.uniform(0.08, 0.2), random.uniform(0.1, 0.3));
  const int marks = static_cast<int>(width_m * height_m / 3.0);
  for (int i = 0; i < marks; ++i) {
    const double u = random.uniform(0.0, width_m);
    const double v = random.uniform(0.0, height_m);
    const double albedo =
        random.chance(0.5) ? random.uniform(0.05, 0.15) : random.uniform(0.65, 0.9);
    if (random.chance(0.5)) {
      draw_stain(canvas, u, v, random.uniform(0.1, 0.5), random);
    } else if (random.chance(0.5)) {
      canvas.stroke(u, v, u + random.uniform(-0.8, 0.8), v + random.uniform(-0.8, 0.8),
                    random.uniform(0.03, 0.08), albedo);
    } else {
      draw_text(canvas, u, v, random.uniform(0.12, 0.3), 1 + random.below(5), albedo, random);
    }
  }
  return std::make_shared<const AlbedoMap>(canvas);
}

std::shared_ptr<const AlbedoMap> panel_ceiling(double width_m, double height_m, Random& random) {
  Canvas canvas(width_m, height_m, kTexelM, 0.7);
  const double panel_m = 0.6;
  draw_tiles(canvas, canvas.whole(), tiles_of(panel_m, panel_m, 0.04, random), random);
  weather(canvas, canvas.whole(), 0.05, random);
  for (double v = 0.0; v < height_m; v += panel_m) {
    for (double u = 0.0; u < width_m; u += panel_m) {
      const Area panel = Area{u, v, panel_m, panel_m}.inset(0.05);
      const double kind = random.uniform();
      if (kind < 0.10) {
        // A lamp's cover: bright, with dark ribs.
        canvas.fill(panel, 0.9);
        for (double rib = 0.1; rib < panel.width_m; rib += 0.1) {
          canvas.fill({panel.u_m + rib, panel.v_m, 0.02, panel.height_m}, 0.25);
        }
      } else if (kind < 0.15) {
        for (double slot = 0.0; slot < panel.height_m; slot += 0.06) {
          canvas.fill({panel.u_m, panel.v_m + slot, panel.width_m, 0.03}, 0.08);
        }
      } else if (kind < 0.22) {
        canvas.disc(u + 0.3, v + 0.3, random.uniform(0.05, 0.12), random.uniform(0.05, 0.3));
      } else if (kind < 0.27) {
        draw_stain(canvas, u + 0.3, v + 0.3, 0.3, random);
      }
    }
  }
  return std::make_shared<const AlbedoMap>(canvas);
}

std::shared_ptr<const AlbedoMap> furniture_side(double width_m, double height_m, Random& random) {
  Canvas canvas(width_m, height_m, kTexelM, 0.4);
  const double kind = random.uniform();
  if (kind < 0.35) {
    draw_shelf(canvas, canvas.whole(), random);
  } else if (kind < 0.75) {
    draw_cabinet(canvas, canvas.whole(), random);
  } else {
    const double board_m = random.uniform(0.1, 0.2);
    draw_tiles(canvas, canvas.whole(), tiles_of(1.5 * width_m, board_m, 0.2, random), random);
    draw_sign(canvas, {0.2 * width_m, 0.4 * height_m, 0.6 * width_m, 0.35 * height_m}, random);
  }
  weather(canvas, canvas.whole(), 0.08, random);
  return std::make_shared<const AlbedoMap>(canvas);
}

}  // namespace glint::synth
