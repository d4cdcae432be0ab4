// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "pcap/synth/canvas.hpp"
#include "pcap/synth/random.hpp"

// Things that people put on walls, floors and furniture, drawn on a canvas. What they show and how
// bright they are follows from `random`; where, from the area. Sizes are those of real things: what
// a lidar image resolves from 1 to 10 m.
namespace glint::synth {

/// `count` letters made of strokes, from (u, v), `height_m` high. Returns the width written, m.
double draw_text(Canvas& canvas, double u_m, double v_m, double height_m, int count, double albedo,
                 Random& random);
/// A sheet with a headline, a picture of discs and blocks, and lines of text.
void draw_poster(Canvas& canvas, const Area& area, Random& random);
/// A small plate with a frame, a symbol or letters.
void draw_sign(Canvas& canvas, const Area& area, Random& random);
/// A board with many sheets pinned to it.
void draw_notice_board(Canvas& canvas, const Area& area, Random& random);
/// Frame, leaf, handle, and now and then a window, a name plate, a vent.
void draw_door(Canvas& canvas, const Area& area, Random& random);
/// Boards with books and boxes of all brightnesses.
void draw_shelf(Canvas& canvas, const Area& area, Random& random);
/// Fronts of drawers and doors, with handles and labels.
void draw_cabinet(Canvas& canvas, const Area& area, Random& random);
/// A stain without sharp shape.
void draw_stain(Canvas& canvas, double u_m, double v_m, double radius_m, Random& random);

}  // namespace glint::synth
