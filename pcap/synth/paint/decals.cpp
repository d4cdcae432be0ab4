// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/decals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pcap/synth/paint/coats.hpp"
#include "pcap/synth/paint/pictures.hpp"

namespace glint::synth {
namespace {

constexpr double kDecalTexelM = 0.01;
constexpr double kAsphalt = 0.15;

// A picture that draw(canvas) fills.
template <class Draw>
std::shared_ptr<const AlbedoMap> picture(double width_m, double height_m, Draw&& draw) {
  Canvas canvas(width_m, height_m, kDecalTexelM, 0.5);
  draw(canvas);
  return std::make_shared<const AlbedoMap>(canvas);
}

}  // namespace

std::shared_ptr<const AlbedoMap> poster(double width_m, double height_m,
                                        std::span<const Photograph> photographs, Random& random) {
  return picture(width_m, height_m,
                 [&](Canvas& canvas) { draw_poster(canvas, canvas.whole(), photographs, random); });
}

std::shared_ptr<const AlbedoMap> notice_board(double width_m, double height_m, Random& random) {
  return picture(width_m, height_m,
                 [&](Canvas& canvas) { draw_notice_board(canvas, canvas.whole(), random); });
}

std::shared_ptr<const AlbedoMap> sign(double width_m, double height_m, Random& random) {
  return picture(width_m, height_m,
                 [&](Canvas& canvas) { draw_sign(canvas, canvas.whole(), random); });
}

std::shared_ptr<const AlbedoMap> house_window(double width_m, double height_m, Random& random) {
  return picture(width_m, height_m,
                 [&](Canvas& canvas) { draw_window(canvas, canvas.whole(), random); });
}

std::shared_ptr<const AlbedoMap> house_door(double width_m, double height_m, Random& random) {
  return picture(width_m, height_m, [&](Canvas& canvas) {
    draw_door(canvas, canvas.whole(), random);
    weather(canvas, canvas.whole(), 0.1, random);
  });
}

std::shared_ptr<const AlbedoMap> number_plate(double width_m, double height_m, Random& random) {
  return picture(width_m, height_m, [&](Canvas& canvas) {
    // Sends light back to where it came from: as bright as can be.
    canvas.fill(canvas.whole(), 1.0);
    const double letter_m = 0.6 * height_m;
    const auto letters = static_cast<int>((width_m - 0.04) / (0.75 * letter_m));
    draw_text(canvas, 0.03, 0.2 * height_m, letter_m, letters, 0.1, random);
  });
}

std::shared_ptr<const AlbedoMap> manhole(double side_m, Random& random) {
  return picture(side_m, side_m, [&](Canvas& canvas) {
    const double middle_m = 0.5 * side_m;
    canvas.fill(canvas.whole(), kAsphalt);
    canvas.disc(middle_m, middle_m, middle_m, 0.05);
    canvas.disc(middle_m, middle_m, 0.86 * middle_m, random.uniform(0.2, 0.35));
    for (double v = 0.12; v < side_m - 0.12; v += 0.1) {
      canvas.fill({0.3 * side_m, v, 0.4 * side_m, 0.04}, 0.07);
    }
  });
}

std::shared_ptr<const AlbedoMap> road_arrow(double width_m, double height_m, Random& random) {
  return picture(width_m, height_m, [&](Canvas& canvas) {
    canvas.fill(canvas.whole(), kAsphalt);
    const double paint = random.uniform(0.5, 0.7);
    const double middle_m = 0.5 * width_m;
    const double head_m = std::min(0.4 * height_m, 1.2);
    canvas.fill({middle_m - 0.08, 0.0, 0.16, height_m - head_m}, paint);
    for (double v = 0.0; v < head_m; v += kDecalTexelM) {
      const double half_m = middle_m * (1.0 - v / head_m);
      canvas.fill({middle_m - half_m, height_m - head_m + v, 2.0 * half_m, kDecalTexelM}, paint);
    }
    roughen(canvas, canvas.whole(), {{0.5, 0.15}, {0.1, 0.2}}, random);
  });
}

std::shared_ptr<const AlbedoMap> wheel(double side_m, Random& random) {
  return picture(side_m, side_m, [&](Canvas& canvas) {
    const double middle_m = 0.5 * side_m;
    const double hub = random.uniform(0.3, 0.8);
    canvas.fill(canvas.whole(), 0.02);
    canvas.disc(middle_m, middle_m, 0.96 * middle_m, 0.06);
    canvas.disc(middle_m, middle_m, 0.62 * middle_m, hub);
    const int holes = 4 + random.below(4);
    for (int i = 0; i < holes; ++i) {
      const double angle_rad = 2.0 * M_PI * i / holes;
      canvas.disc(middle_m + 0.38 * middle_m * std::cos(angle_rad),
                  middle_m + 0.38 * middle_m * std::sin(angle_rad), 0.12 * middle_m, 0.08);
    }
  });
}

std::shared_ptr<const AlbedoMap> car_flank(double width_m, double height_m, double paint,
                                           Random& random) {
  return picture(width_m, height_m, [&](Canvas& canvas) {
    const double joint = paint > 0.15 ? 0.3 * paint : 2.0 * paint;
    canvas.fill(canvas.whole(), paint);
    canvas.fill({0.0, 0.0, width_m, 0.1}, 0.05);
    for (const double at : {0.32, 0.54, 0.74}) {
      canvas.fill({at * width_m, 0.1, 0.02, height_m - 0.1}, joint);
    }
    for (const double at : {0.5, 0.7}) {
      canvas.fill({at * width_m, height_m - 0.16, 0.14, 0.04}, joint);
    }
    if (random.chance(0.4)) canvas.fill({0.2 * width_m, 0.35, 0.6 * width_m, 0.04}, 0.06);
    if (random.chance(0.15)) {
      // A firm's car.
      draw_text(canvas, 0.34 * width_m, 0.2, 0.22, 6, paint > 0.3 ? 0.06 : 0.8, random);
    }
    roughen(canvas, canvas.whole(), {{0.6, 0.06}}, random);
  });
}

}  // namespace glint::synth
