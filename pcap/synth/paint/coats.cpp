// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/coats.hpp"

#include <algorithm>
#include <cmath>

namespace glint::synth {

void roughen(Canvas& canvas, const Area& area, std::initializer_list<Grain> grains,
             Random& random) {
  for (const Grain& grain : grains) {
    canvas.blotch(area, grain.size_m, grain.contrast, random.next());
  }
}

void weather(Canvas& canvas, const Area& area, double contrast, Random& random) {
  roughen(canvas, area,
          {{random.uniform(1.5, 3.0), contrast},
           {random.uniform(0.3, 0.6), 0.7 * contrast},
           {0.08, 0.4 * contrast}},
          random);
}

void draw_tiles(Canvas& canvas, const Area& area, const Tiling& tiling, Random& random) {
  canvas.fill(area, tiling.joint_albedo);
  bool shifted = false;
  for (double v = 0.0; v < area.height_m;
       v += tiling.height_m, shifted = tiling.bricks && !shifted) {
    for (double u = shifted ? -0.5 * tiling.width_m : 0.0; u < area.width_m; u += tiling.width_m) {
      const double left = std::max(0.0, u);
      const double right = std::min(area.width_m, u + tiling.width_m - tiling.joint_m);
      const double top = std::min(area.height_m, v + tiling.height_m - tiling.joint_m);
      canvas.fill({area.u_m + left, area.v_m + v, right - left, top - v},
                  tiling.albedo * (1.0 + tiling.contrast * random.gaussian()));
    }
  }
}

void draw_crack(Canvas& canvas, double u_m, double v_m, double heading_rad, double length_m,
                double thickness_m, double albedo, Random& random) {
  constexpr double kStepM = 0.15;
  for (double way_m = 0.0; way_m < length_m; way_m += kStepM) {
    const double to_u_m = u_m + kStepM * std::cos(heading_rad);
    const double to_v_m = v_m + kStepM * std::sin(heading_rad);
    canvas.stroke(u_m, v_m, to_u_m, to_v_m, thickness_m, albedo);
    u_m = to_u_m;
    v_m = to_v_m;
    heading_rad += random.uniform(-0.45, 0.45);
  }
}

}  // namespace glint::synth
