// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <span>

#include "pcap/synth/paint/canvas.hpp"
#include "pcap/synth/paint/photograph.hpp"
#include "pcap/synth/random.hpp"

// Things that people put on walls, floors and furniture, drawn on a canvas. What they show and how
// bright they are follows from `random`; where, from the area. Sizes are those of real things: what
// a lidar image resolves from 1 to 10 m.
namespace glint::synth {

/// `count` letters made of strokes, from (u, v), `height_m` high. Returns the width written, m.
double draw_text(Canvas& canvas, double u_m, double v_m, double height_m, int count, double albedo,
                 Random& random);
/// A sheet with a headline, a picture of discs and blocks, and lines of text; where there are
/// photographs, more often one of them.
void draw_poster(Canvas& canvas, const Area& area, std::span<const Photograph> photographs,
                 Random& random);
/// The middle of a photograph, as much as has the area's proportions.
void draw_photograph(Canvas& canvas, const Area& area, const Photograph& photograph);
/// A small plate with a frame, a symbol or letters.
void draw_sign(Canvas& canvas, const Area& area, Random& random);
/// A board with many sheets pinned to it.
void draw_notice_board(Canvas& canvas, const Area& area, Random& random);
/// Frame, leaf, handle, and now and then a window, a name plate, a vent.
void draw_door(Canvas& canvas, const Area& area, Random& random);
/// Frame, bars and dark panes, now and then with a curtain or a blind.
void draw_window(Canvas& canvas, const Area& area, Random& random);
/// A recess in a tunnel's wall: a dark opening in a bright frame, a number over it.
void draw_niche(Canvas& canvas, const Area& area, Random& random);
/// Boards with books and boxes of all brightnesses.
void draw_shelf(Canvas& canvas, const Area& area, Random& random);
/// Fronts of drawers and doors, with handles and labels.
void draw_cabinet(Canvas& canvas, const Area& area, Random& random);
/// A stain without sharp shape.
void draw_stain(Canvas& canvas, double u_m, double v_m, double radius_m, Random& random);

}  // namespace glint::synth
