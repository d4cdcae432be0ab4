// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glint::cli {
namespace {

constexpr double kLeft_px = 64, kRight_px = 16, kTop_px = 16, kBottom_px = 44;
constexpr std::size_t kMostPoints = 4000;
constexpr std::array<const char*, 4> kColours = {"#1769aa", "#c2410c", "#2e7d32", "#7b1fa2"};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  [[nodiscard]] double span() const { return high - low; }
  // Never empty: a little room on both sides, also round a constant.
  void pad() {
    if (!(low <= high)) low = high = 0.0;
    const double room = std::max(0.04 * span(), 1e-3 * std::max(1.0, std::abs(high)));
    low -= room;
    high += room;
  }
  void widen_to(double wanted_span) {
    const double more = 0.5 * (wanted_span - span());
    low -= more;
    high += more;
  }
};

// The distance between ticks: 1, 2 or 5 times a power of ten, about six of them.
double tick_step(double span) {
  const double rough = span / 6.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

struct Axes {
  Range x, y;
  double width_px, height_px;
  [[nodiscard]] double px(double v) const {
    return kLeft_px + (v - x.low) / x.span() * (width_px - kLeft_px - kRight_px);
  }
  [[nodiscard]] double py(double v) const {
    return height_px - kBottom_px - (v - y.low) / y.span() * (height_px - kTop_px - kBottom_px);
  }
};

std::string grid(const Axes& axes) {
  std::string svg;
  const double bottom_px = axes.height_px - kBottom_px;
  const double step_x = tick_step(axes.x.span());
  for (double v = std::ceil(axes.x.low / step_x) * step_x; v <= axes.x.high; v += step_x) {
    const double tick = std::abs(v) < 1e-9 * step_x ? 0.0 : v;
    svg += fmt::format(R"(<line class="grid" x1="{0:.1f}" y1="{1}" x2="{0:.1f}" y2="{2:.1f}"/>)"
                       R"(<text x="{0:.1f}" y="{3:.1f}" text-anchor="middle">{4:.6g}</text>)",
                       axes.px(v), kTop_px, bottom_px, bottom_px + 16, tick);
  }
  const double step_y = tick_step(axes.y.span());
  for (double v = std::ceil(axes.y.low / step_y) * step_y; v <= axes.y.high; v += step_y) {
    const double tick = std::abs(v) < 1e-9 * step_y ? 0.0 : v;
    svg += fmt::format(R"(<line class="grid" x1="{0}" y1="{1:.1f}" x2="{2:.1f}" y2="{1:.1f}"/>)"
                       R"(<text x="{3}" y="{4:.1f}" text-anchor="end">{5:.6g}</text>)",
                       kLeft_px, axes.py(v), axes.width_px - kRight_px, kLeft_px - 6,
                       axes.py(v) + 4, tick);
  }
  return svg;
}

std::string polyline(const Curve& curve, const Axes& axes, const char* colour) {
  std::string points;
  const std::size_t step = curve.points.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < curve.points.size(); i += step) {
    const auto& [x, y] = curve.points[i];
    if (std::isfinite(x) && std::isfinite(y)) {
      points += fmt::format("{:.1f},{:.1f} ", axes.px(x), axes.py(y));
    }
  }
  return fmt::format(R"(<polyline fill="none" stroke="{}" stroke-width="1.6" points="{}"/>)",
                     colour, points);
}

}  // namespace

std::string svg_plot(const std::vector<Curve>& curves, const PlotOptions& options) {
  Axes axes{{}, {}, static_cast<double>(options.width_px), static_cast<double>(options.height_px)};
  for (const Curve& curve : curves) {
    for (const auto& [x, y] : curve.points) {
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      axes.x.add(x);
      axes.y.add(y);
    }
  }
  axes.x.pad();
  axes.y.pad();
  if (options.equal_scale) {
    const double units_x = axes.x.span() / (axes.width_px - kLeft_px - kRight_px);
    const double units_y = axes.y.span() / (axes.height_px - kTop_px - kBottom_px);
    if (units_x > units_y) {
      axes.y.widen_to(axes.y.span() * units_x / units_y);
    } else {
      axes.x.widen_to(axes.x.span() * units_y / units_x);
    }
  }
  std::string svg =
      fmt::format(R"(<svg viewBox="0 0 {} {}" role="img">)", options.width_px, options.height_px);
  svg += grid(axes);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const char* colour = kColours[i % kColours.size()];
    svg += polyline(curves[i], axes, colour);
    if (!curves[i].name.empty()) {
      svg += fmt::format(R"(<text x="{}" y="{}" fill="{}" class="legend">{}</text>)", kLeft_px + 8,
                         kTop_px + 14 + 16 * static_cast<double>(i), colour,
                         html_escaped(curves[i].name));
    }
  }
  svg += fmt::format(R"(<text x="{:.0f}" y="{}" text-anchor="middle">{}</text>)",
                     0.5 * axes.width_px, options.height_px - 8, html_escaped(options.x_label));
  svg += fmt::format(R"svg(<text transform="translate(14 {:.0f}) rotate(-90)" )svg"
                     R"svg(text-anchor="middle">{}</text></svg>)svg",
                     0.5 * axes.height_px, html_escaped(options.y_label));
  return svg;
}

std::string html_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace glint::cli
