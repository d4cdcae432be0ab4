// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace glint::synth {
namespace {

// Bright on dark or dark on bright, with a contrast that print has.
struct Ink {
  double paper;
  double ink;
};
Ink choose_ink(Random& random) {
  const double bright = random.uniform(0.55, 0.92);
  const double dark = random.uniform(0.04, 0.28);
  return random.chance(0.7) ? Ink{bright, dark} : Ink{dark, bright};
}

// A letter: a few strokes between the points of a 2 x 3 grid.
void draw_letter(Canvas& canvas, double u_m, double v_m, double height_m, double albedo,
                 Random& random) {
  const double width_m = 0.5 * height_m;
  const int strokes = 2 + random.below(3);
  int from = random.below(6);
  for (int i = 0; i < strokes; ++i) {
    const int to = (from + 1 + random.below(5)) % 6;
    // Points 0 to 5 are the corners of two squares, one on the other.
    const auto u = [&](int point) { return u_m + width_m * (point % 2); };
    const auto v = [&](int point) {
      const int row = point / 2;
      return v_m + 0.5 * height_m * row;
    };
    canvas.stroke(u(from), v(from), u(to), v(to), 0.17 * height_m, albedo);
    from = to;
  }
}

// Words over the area's width, from its top downwards.
void draw_lines(Canvas& canvas, const Area& area, double letter_m, double albedo, Random& random) {
  const double top_m = area.v_m + area.height_m;
  for (double v = top_m - letter_m; v >= area.v_m; v -= 1.9 * letter_m) {
    const double full_m = area.width_m * random.uniform(0.5, 1.0);
    for (double u = area.u_m; u < area.u_m + full_m;) {
      const int letters = 2 + random.below(7);
      const auto fitting = static_cast<int>((area.u_m + full_m - u) / (0.75 * letter_m));
      if (fitting < 1) break;
      u += draw_text(canvas, u, v, letter_m, std::min(letters, fitting), albedo, random);
      u += 0.8 * letter_m;
    }
  }
}

void draw_picture(Canvas& canvas, const Area& area, Random& random) {
  canvas.fill(area, random.uniform(0.1, 0.8));
  const int parts = 3 + random.below(5);
  for (int i = 0; i < parts; ++i) {
    const double albedo = random.uniform(0.04, 0.92);
    const double size_m = random.uniform(0.12, 0.4) * std::min(area.width_m, area.height_m);
    const double u = random.uniform(area.u_m + size_m, area.u_m + area.width_m - size_m);
    const double v = random.uniform(area.v_m + size_m, area.v_m + area.height_m - size_m);
    if (random.chance(0.4)) {
      canvas.disc(u, v, size_m, albedo);
    } else {
      canvas.fill({u - size_m, v - size_m, size_m * random.uniform(0.6, 2.0),
                   size_m * random.uniform(0.6, 2.0)},
                  albedo);
    }
  }
}

}  // namespace

double draw_text(Canvas& canvas, double u_m, double v_m, double height_m, int count, double albedo,
                 Random& random) {
  const double step_m = 0.75 * height_m;
  for (int i = 0; i < count; ++i) {
    draw_letter(canvas, u_m + i * step_m, v_m, height_m, albedo, random);
  }
  return count * step_m;
}

void draw_photograph(Canvas& canvas, const Area& area, const Photograph& photograph) {
  // Pixels a metre that fill the area, and the pixel at its upper left corner.
  const double scale = std::min(photograph.width / area.width_m, photograph.height / area.height_m);
  const double left = 0.5 * (photograph.width - scale * area.width_m);
  const double top = 0.5 * (photograph.height - scale * area.height_m);
  const double half = 0.5 * scale * canvas.texel_m();
  const auto range = [&](double middle, int count) {
    const int first = std::clamp(static_cast<int>(std::lround(middle - half)), 0, count - 1);
    const int last = std::clamp(static_cast<int>(std::lround(middle + half)), first + 1, count);
    return std::pair(first, last);
  };
  // A texel is the mean of the pixels that it covers.
  canvas.paint(area, [&](double u_m, double v_m) {
    const auto [x0, x1] = range(left + scale * (u_m - area.u_m), photograph.width);
    const auto [y0, y1] = range(top + scale * (area.v_m + area.height_m - v_m), photograph.height);
    int sum = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        sum +=
            photograph
                .pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(photograph.width) +
                        static_cast<std::size_t>(x)];
      }
    }
    return sum / (255.0 * (x1 - x0) * (y1 - y0));
  });
}

void draw_poster(Canvas& canvas, const Area& area, std::span<const Photograph> photographs,
                 Random& random) {
  if (!photographs.empty() && random.chance(0.8)) {
    const int index = random.below(static_cast<int>(photographs.size()));
    draw_photograph(canvas, area, photographs[static_cast<std::size_t>(index)]);
    return;
  }
  const Ink ink = choose_ink(random);
  canvas.fill(area, ink.paper);
  if (random.chance(0.5)) canvas.frame(area, 0.03, ink.ink);
  const Area inner = area.inset(0.07);
  const double headline_m = std::clamp(0.16 * inner.height_m, 0.05, 0.2);
  const auto letters = static_cast<int>(inner.width_m / (0.75 * headline_m));
  draw_text(canvas, inner.u_m, inner.v_m + inner.height_m - headline_m, headline_m,
            std::max(1, letters - random.below(3)), ink.ink, random);
  const double rest_m = inner.height_m - 1.4 * headline_m;
  const double text_m = random.uniform(0.2, 0.7) * rest_m;
  draw_picture(canvas, {inner.u_m, inner.v_m + text_m, inner.width_m, rest_m - text_m}, random);
  draw_lines(canvas, {inner.u_m, inner.v_m, inner.width_m, text_m - 0.04},
             random.uniform(0.03, 0.06), ink.ink, random);
}

void draw_sign(Canvas& canvas, const Area& area, Random& random) {
  const Ink ink = choose_ink(random);
  canvas.fill(area, ink.paper);
  canvas.frame(area, 0.02, ink.ink);
  const Area inner = area.inset(0.05);
  if (random.chance(0.5)) {
    const double letter_m = std::min(inner.height_m, 0.16);
    const auto letters = std::max(1, static_cast<int>(inner.width_m / (0.75 * letter_m)));
    draw_text(canvas, inner.u_m, inner.v_m + 0.5 * (inner.height_m - letter_m), letter_m, letters,
              ink.ink, random);
    return;
  }
  const double u = area.u_m + 0.5 * area.width_m;
  const double v = area.v_m + 0.5 * area.height_m;
  const double radius_m = 0.45 * std::min(inner.width_m, inner.height_m);
  canvas.disc(u, v, radius_m, ink.ink);
  canvas.disc(u, v, 0.65 * radius_m, ink.paper);
  const double turn_rad = random.uniform(0.0, 3.2);
  canvas.stroke(u - 0.5 * radius_m * std::cos(turn_rad), v - 0.5 * radius_m * std::sin(turn_rad),
                u + 0.5 * radius_m * std::cos(turn_rad), v + 0.5 * radius_m * std::sin(turn_rad),
                0.3 * radius_m, ink.ink);
}

void draw_notice_board(Canvas& canvas, const Area& area, Random& random) {
  canvas.fill(area, random.uniform(0.2, 0.45));
  canvas.frame(area, 0.04, random.uniform(0.05, 0.8));
  const int sheets = 4 + static_cast<int>(6.0 * area.width_m * area.height_m);
  for (int i = 0; i < sheets; ++i) {
    const double width_m = random.chance(0.5) ? 0.21 : 0.30;
    const Area sheet{random.uniform(area.u_m + 0.05, area.u_m + area.width_m - width_m - 0.05),
                     random.uniform(area.v_m + 0.05, area.v_m + area.height_m - 0.35), width_m,
                     0.30};
    const Ink ink = choose_ink(random);
    canvas.fill(sheet, ink.paper);
    if (random.chance(0.4)) {
      draw_picture(canvas, sheet.inset(0.03), random);
    } else {
      draw_lines(canvas, sheet.inset(0.03), 0.035, ink.ink, random);
    }
  }
}

void draw_door(Canvas& canvas, const Area& area, Random& random) {
  const double leaf = random.uniform(0.08, 0.8);
  const double fitting = leaf > 0.4 ? random.uniform(0.04, 0.2) : random.uniform(0.6, 0.9);
  canvas.fill(area, random.uniform(0.1, 0.9));
  const Area inner{area.u_m + 0.07, area.v_m, area.width_m - 0.14, area.height_m - 0.07};
  canvas.fill(inner, leaf);
  const bool hinged_left = random.chance(0.5);
  const double handle_u = hinged_left ? inner.u_m + inner.width_m - 0.12 : inner.u_m + 0.05;
  canvas.fill({handle_u, area.v_m + 0.92, 0.06, 0.24}, fitting);
  canvas.stroke(handle_u + 0.03, area.v_m + 1.08, handle_u + (hinged_left ? -0.09 : 0.15),
                area.v_m + 1.08, 0.03, fitting);
  if (random.chance(0.35)) {
    canvas.fill({inner.u_m + 0.25, area.v_m + 1.25, inner.width_m - 0.5, 0.55},
                random.uniform(0.03, 0.12));
  } else if (random.chance(0.7)) {
    draw_sign(canvas, {inner.u_m + 0.25, area.v_m + 1.45, inner.width_m - 0.5, 0.2}, random);
  }
  if (random.chance(0.3)) {
    const Area vent{inner.u_m + 0.15, area.v_m + 0.15, inner.width_m - 0.3, 0.3};
    for (double v = 0.0; v < vent.height_m; v += 0.06) {
      canvas.fill({vent.u_m, vent.v_m + v, vent.width_m, 0.03}, fitting);
    }
  }
}

void draw_window(Canvas& canvas, const Area& area, Random& random) {
  const double frame = random.chance(0.7) ? random.uniform(0.55, 0.85) : random.uniform(0.1, 0.25);
  canvas.fill(area, frame);
  const Area glass = area.inset(0.07);
  canvas.fill(glass, random.uniform(0.03, 0.09));
  if (random.chance(0.35)) {
    // Curtains: folds at either side.
    const double width_m = random.uniform(0.15, 0.35) * glass.width_m;
    const double cloth = random.uniform(0.2, 0.4);
    canvas.fill({glass.u_m, glass.v_m, width_m, glass.height_m}, cloth);
    canvas.fill({glass.u_m + glass.width_m - width_m, glass.v_m, width_m, glass.height_m}, cloth);
  } else if (random.chance(0.3)) {
    const double down_m = random.uniform(0.3, 0.9) * glass.height_m;
    for (double v = 0.0; v < down_m; v += 0.08) {
      canvas.fill({glass.u_m, glass.v_m + glass.height_m - v - 0.05, glass.width_m, 0.05}, 0.4);
    }
  }
  const int bars = random.below(3);
  for (int i = 1; i <= bars; ++i) {
    canvas.fill(
        {glass.u_m + glass.width_m * i / (bars + 1) - 0.025, glass.v_m, 0.05, glass.height_m},
        frame);
  }
  if (random.chance(0.5)) {
    canvas.fill({glass.u_m, glass.v_m + 0.66 * glass.height_m, glass.width_m, 0.05}, frame);
  }
}

void draw_niche(Canvas& canvas, const Area& area, Random& random) {
  canvas.fill(area, random.uniform(0.03, 0.1));
  canvas.frame(area, 0.12, random.uniform(0.5, 0.8));
  const double over_m = area.v_m + area.height_m + 0.1;
  canvas.fill({area.u_m, over_m, area.width_m, 0.35}, 0.7);
  draw_text(canvas, area.u_m + 0.1, over_m + 0.06, 0.24, 3, 0.05, random);
}

void draw_shelf(Canvas& canvas, const Area& area, Random& random) {
  const double board = random.uniform(0.3, 0.8);
  canvas.fill(area, 0.05);
  const double gap_m = random.uniform(0.28, 0.40);
  for (double v = 0.0; v < area.height_m; v += gap_m) {
    for (double u = 0.03; u < area.width_m - 0.03;) {
      const double width_m =
          random.chance(0.75) ? random.uniform(0.02, 0.07) : random.uniform(0.12, 0.35);
      const double high_m = std::min(gap_m - 0.04, random.uniform(0.6, 0.97) * gap_m);
      const Area thing{area.u_m + u, area.v_m + v + 0.03, std::min(width_m, area.width_m - u),
                       high_m};
      if (random.chance(0.88)) canvas.fill(thing, random.uniform(0.05, 0.85));
      if (width_m > 0.1) draw_sign(canvas, thing.inset(0.03), random);
      u += width_m + 0.005;
    }
    canvas.fill({area.u_m, area.v_m + v, area.width_m, 0.03}, board);
  }
  canvas.frame(area, 0.03, board);
}

void draw_cabinet(Canvas& canvas, const Area& area, Random& random) {
  const double front = random.uniform(0.12, 0.85);
  const double joint = front > 0.4 ? 0.4 * front : 1.8 * front + 0.1;
  const double handle = front > 0.4 ? random.uniform(0.03, 0.15) : random.uniform(0.6, 0.9);
  canvas.fill(area, front);
  const double width_m = random.uniform(0.35, 0.6);
  const double height_m = random.uniform(0.25, 0.7);
  for (double u = 0.0; u < area.width_m - 0.1; u += width_m) {
    for (double v = 0.0; v < area.height_m - 0.1; v += height_m) {
      const Area drawer{area.u_m + u, area.v_m + v, width_m, height_m};
      canvas.frame(drawer, 0.015, joint);
      const double top_m = drawer.v_m + drawer.height_m;
      canvas.fill({drawer.u_m + 0.35 * width_m, top_m - 0.10, 0.3 * width_m, 0.03}, handle);
      if (random.chance(0.35)) {
        draw_sign(canvas, {drawer.u_m + 0.08, drawer.v_m + 0.05, 0.18, 0.12}, random);
      }
    }
  }
}

void draw_stain(Canvas& canvas, double u_m, double v_m, double radius_m, Random& random) {
  const std::uint64_t seed = random.next();
  const double contrast = random.uniform(0.15, 0.5);
  for (int i = 0; i < 3; ++i) {
    const double r = radius_m * (1.0 - 0.25 * i);
    canvas.blotch({u_m - r, v_m - 0.7 * r, 2.0 * r, 1.4 * r}, 0.6 * radius_m, 0.5 * contrast,
                  seed + static_cast<std::uint64_t>(i));
  }
}

}  // namespace glint::synth
