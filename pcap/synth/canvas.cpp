// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/canvas.hpp"

#include <algorithm>
#include <cmath>

#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

double lattice(std::uint64_t seed, std::int64_t i, std::int64_t j) {
  const std::uint64_t bits =
      hash_keys({seed, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)});
  return static_cast<double>(bits >> 11U) * 0x1.0p-52 - 1.0;
}

double ease(double t) { return t * t * (3.0 - 2.0 * t); }

// Texels [first, last) of `count` whose centres lie in [from, to).
std::pair<int, int> texel_range(double from_m, double to_m, double texel_m, int count) {
  const auto clip = [&](double at_m) {
    return static_cast<int>(std::clamp(std::ceil(at_m / texel_m - 0.5), 0.0, 1.0 * count));
  };
  return {clip(from_m), clip(to_m)};
}

}  // namespace

Canvas::Canvas(double width_m, double height_m, double texel_m, double albedo)
    : texel_m_(texel_m),
      columns_(std::max(2, static_cast<int>(std::lround(width_m / texel_m)))),
      rows_(std::max(2, static_cast<int>(std::lround(height_m / texel_m)))),
      texels_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
              static_cast<float>(albedo)) {}

template <class Draw>
void Canvas::each(const Area& area, Draw&& draw) {
  const auto [left, right] = texel_range(area.u_m, area.u_m + area.width_m, texel_m_, columns_);
  const auto [low, high] = texel_range(area.v_m, area.v_m + area.height_m, texel_m_, rows_);
  for (int y = low; y < high; ++y) {
    float* row = &texels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_)];
    for (int x = left; x < right; ++x) draw(row[x], (x + 0.5) * texel_m_, (y + 0.5) * texel_m_);
  }
}

void Canvas::fill(const Area& area, double albedo) {
  each(area, [&](float& texel, double, double) { texel = static_cast<float>(albedo); });
}

void Canvas::frame(const Area& area, double thickness_m, double albedo) {
  const double t = thickness_m;
  fill({area.u_m, area.v_m, area.width_m, t}, albedo);
  fill({area.u_m, area.v_m + area.height_m - t, area.width_m, t}, albedo);
  fill({area.u_m, area.v_m, t, area.height_m}, albedo);
  fill({area.u_m + area.width_m - t, area.v_m, t, area.height_m}, albedo);
}

void Canvas::disc(double u_m, double v_m, double radius_m, double albedo) {
  each({u_m - radius_m, v_m - radius_m, 2.0 * radius_m, 2.0 * radius_m},
       [&](float& texel, double u, double v) {
         if (std::hypot(u - u_m, v - v_m) < radius_m) texel = static_cast<float>(albedo);
       });
}

void Canvas::stroke(double u0_m, double v0_m, double u1_m, double v1_m, double thickness_m,
                    double albedo) {
  const double half_m = 0.5 * thickness_m;
  const double du = u1_m - u0_m;
  const double dv = v1_m - v0_m;
  const double squared = std::max(1e-12, du * du + dv * dv);
  each({std::min(u0_m, u1_m) - half_m, std::min(v0_m, v1_m) - half_m, std::abs(du) + thickness_m,
        std::abs(dv) + thickness_m},
       [&](float& texel, double u, double v) {
         const double along = std::clamp(((u - u0_m) * du + (v - v0_m) * dv) / squared, 0.0, 1.0);
         if (std::hypot(u - u0_m - along * du, v - v0_m - along * dv) < half_m) {
           texel = static_cast<float>(albedo);
         }
       });
}

void Canvas::blotch(const Area& area, double size_m, double contrast, std::uint64_t seed) {
  each(area, [&](float& texel, double u, double v) {
    const double x = u / size_m;
    const double y = v / size_m;
    const auto i = static_cast<std::int64_t>(std::floor(x));
    const auto j = static_cast<std::int64_t>(std::floor(y));
    const double sx = ease(x - static_cast<double>(i));
    const double sy = ease(y - static_cast<double>(j));
    const double low = lattice(seed, i, j) * (1.0 - sx) + lattice(seed, i + 1, j) * sx;
    const double high = lattice(seed, i, j + 1) * (1.0 - sx) + lattice(seed, i + 1, j + 1) * sx;
    texel *= static_cast<float>(1.0 + contrast * (low * (1.0 - sy) + high * sy));
  });
}

}  // namespace glint::synth
