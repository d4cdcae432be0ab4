// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <initializer_list>

#include "pcap/synth/paint/canvas.hpp"
#include "pcap/synth/random.hpp"

// What covers an area as a whole, below whatever hangs on it.
namespace glint::synth {

/// Features of about `size_m`, brighter and darker by up to the share `contrast`.
struct Grain {
  double size_m;
  double contrast;
};
/// Unevenness at several scales, as every real surface has it.
void roughen(Canvas& canvas, const Area& area, std::initializer_list<Grain> grains, Random& random);
/// Uneven paint, wear and dirt.
void weather(Canvas& canvas, const Area& area, double contrast, Random& random);

struct Tiling {
  double width_m = 0.3;  ///< Of a tile with its joint.
  double height_m = 0.3;
  double joint_m = 0.02;
  bool bricks = false;    ///< Every other row is shifted by half a tile.
  double contrast = 0.1;  ///< Deviation of the tiles' albedo, relative.
  double albedo = 0.4;
  double joint_albedo = 0.2;
};
/// Tiles in rows from the area's lower left corner on.
void draw_tiles(Canvas& canvas, const Area& area, const Tiling& tiling, Random& random);

/// A crack, vein or furrow that wanders from a place on, some `length_m` long.
void draw_crack(Canvas& canvas, double u_m, double v_m, double heading_rad, double length_m,
                double thickness_m, double albedo, Random& random);

}  // namespace glint::synth
