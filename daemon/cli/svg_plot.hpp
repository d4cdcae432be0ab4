// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace glint::cli {

/// One curve of a plot.
struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

struct PlotOptions {
  std::string x_label;
  std::string y_label;
  bool equal_scale = false;  ///< One unit is as long along x as along y, as on a map.
  int width_px = 640;
  int height_px = 360;
};

/// A line plot as an SVG element, with axes, round-numbered ticks and a legend of named curves.
/// Points that are not finite are left out. Curves of many points are thinned to what can be seen.
std::string svg_plot(const std::vector<Curve>& curves, const PlotOptions& options);

/// `text` with the characters that mean something in HTML escaped.
std::string html_escaped(const std::string& text);

}  // namespace glint::cli
