// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/canvas.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

int texels_over(double size_m, double texel_m, Edges edges) {
  const auto count = static_cast<unsigned>(std::max(2.0, std::round(size_m / texel_m)));
  return static_cast<int>(edges == Edges::kRepeat ? std::bit_ceil(count) : count);
}

// Texels [first, last) whose centres lie in [from, to), of `count`; those of a picture that repeats
// may have any number, but each comes only once.
std::pair<int, int> texel_range(double from_m, double to_m, double texel_m, int count,
                                Edges edges) {
  const auto at = [&](double place_m, double low, double high) {
    return static_cast<int>(std::clamp(std::ceil(place_m / texel_m - 0.5), low, high));
  };
  if (edges == Edges::kGoOn) return {at(from_m, 0.0, count), at(to_m, 0.0, count)};
  const int first = at(from_m, -1e6, 1e6);
  return {first, at(to_m, first, first + count)};
}

// Smooth noise in [-1, 1] between the points of a lattice, for evenly spaced places, row by row.
class Noise {
 public:
  // After `period` points the lattice comes again; 0: never.
  struct Axis {
    double size_m;
    std::int64_t period;
  };

  // Rows of `count` places from `first_u_m` on.
  Noise(std::uint64_t seed, Axis u, Axis v, double first_u_m, double step_m, int count)
      : seed_(seed), u_(u), v_(v), first_(cell(first_u_m, u)) {
    for (int i = 0; i < count; ++i) {
      const double u_m = first_u_m + i * step_m;
      const std::int64_t at = cell(u_m, u);
      columns_.push_back({static_cast<std::size_t>(at - first_), weight(u_m, at, u)});
    }
    const std::size_t points = columns_.empty() ? 0 : columns_.back().point + 2;
    low_.resize(points);
    high_.resize(points);
    between_.resize(points);
    values_.resize(columns_.size());
  }

  // Neighbouring rows share their lattice points: ask for them in order.
  std::span<const float> row(double v_m) {
    const std::int64_t at = cell(v_m, v_);
    if (at != at_) {
      at_ = at;
      for (std::size_t i = 0; i < low_.size(); ++i) {
        low_[i] = point(first_ + static_cast<std::int64_t>(i), at);
        high_[i] = point(first_ + static_cast<std::int64_t>(i), at + 1);
      }
    }
    const float w = weight(v_m, at, v_);
    for (std::size_t i = 0; i < low_.size(); ++i) between_[i] = low_[i] + (high_[i] - low_[i]) * w;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const float* left = &between_[columns_[i].point];
      values_[i] = left[0] + (left[1] - left[0]) * columns_[i].weight;
    }
    return values_;
  }

 private:
  struct Column {
    std::size_t point;  // The lattice point on its left,
    float weight;       // and how much that on its right counts.
  };

  static std::int64_t cell(double at_m, const Axis& axis) {
    return static_cast<std::int64_t>(std::floor(at_m / axis.size_m));
  }
  static float weight(double at_m, std::int64_t cell, const Axis& axis) {
    const double t = at_m / axis.size_m - static_cast<double>(cell);
    return static_cast<float>(t * t * (3.0 - 2.0 * t));
  }
  static std::int64_t again(std::int64_t i, const Axis& axis) {
    return axis.period > 0 ? (i % axis.period + axis.period) % axis.period : i;
  }
  [[nodiscard]] float point(std::int64_t i, std::int64_t j) const {
    const std::uint64_t bits = hash_keys({seed_, static_cast<std::uint64_t>(again(i, u_)),
                                          static_cast<std::uint64_t>(again(j, v_))});
    return static_cast<float>(static_cast<double>(bits >> 11U) * 0x1.0p-52 - 1.0);
  }

  const std::uint64_t seed_;
  const Axis u_;
  const Axis v_;
  const std::int64_t first_;
  std::int64_t at_ = std::numeric_limits<std::int64_t>::max();
  std::vector<Column> columns_;
  std::vector<float> low_;  // Lattice points below and above the row, and those between in it.
  std::vector<float> high_;
  std::vector<float> between_;
  std::vector<float> values_;
};

double squared(double x, double y = 0.0) { return x * x + y * y; }

Noise::Axis noise_axis(double length_m, double size_m, Edges edges) {
  if (edges == Edges::kGoOn) return {size_m, 0};
  const auto period = std::max<std::int64_t>(1, std::llround(length_m / size_m));
  return {length_m / static_cast<double>(period), period};
}

}  // namespace

Canvas::Canvas(double width_m, double height_m, double texel_m, double albedo, Edges edges)
    : texel_m_(texel_m),
      columns_(texels_over(width_m, texel_m, edges)),
      rows_(texels_over(height_m, texel_m, edges)),
      edges_(edges),
      texels_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
              static_cast<float>(albedo)) {}

template <class Draw>
void Canvas::each(const Area& area, Draw&& draw) {
  const auto [left, right] =
      texel_range(area.u_m, area.u_m + area.width_m, texel_m_, columns_, edges_);
  const auto [low, high] = texel_range(area.v_m, area.v_m + area.height_m, texel_m_, rows_, edges_);
  // Powers of two: a mask takes any number to the texel that comes there again.
  const int column_mask = edges_ == Edges::kRepeat ? columns_ - 1 : -1;
  const int row_mask = edges_ == Edges::kRepeat ? rows_ - 1 : -1;
  for (int y = low; y < high; ++y) {
    float* row =
        &texels_[static_cast<std::size_t>(y & row_mask) * static_cast<std::size_t>(columns_)];
    for (int x = left; x < right; ++x) {
      draw(row[x & column_mask], (x + 0.5) * texel_m_, (y + 0.5) * texel_m_);
    }
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
         if (squared(u - u_m, v - v_m) < squared(radius_m)) texel = static_cast<float>(albedo);
       });
}

void Canvas::stroke(double u0_m, double v0_m, double u1_m, double v1_m, double thickness_m,
                    double albedo) {
  const double half_m = 0.5 * thickness_m;
  const double du = u1_m - u0_m;
  const double dv = v1_m - v0_m;
  const double length2 = std::max(1e-12, squared(du, dv));
  each({std::min(u0_m, u1_m) - half_m, std::min(v0_m, v1_m) - half_m, std::abs(du) + thickness_m,
        std::abs(dv) + thickness_m},
       [&](float& texel, double u, double v) {
         const double along = std::clamp(((u - u0_m) * du + (v - v0_m) * dv) / length2, 0.0, 1.0);
         if (squared(u - u0_m - along * du, v - v0_m - along * dv) < squared(half_m)) {
           texel = static_cast<float>(albedo);
         }
       });
}

void Canvas::blotch(const Area& area, double size_m, double contrast, std::uint64_t seed) {
  const auto [left, right] =
      texel_range(area.u_m, area.u_m + area.width_m, texel_m_, columns_, edges_);
  Noise noise(seed, noise_axis(whole().width_m, size_m, edges_),
              noise_axis(whole().height_m, size_m, edges_), (left + 0.5) * texel_m_, texel_m_,
              right - left);
  const auto strength = static_cast<float>(contrast);
  std::span<const float> row;
  std::size_t column = 0;
  each(area, [&](float& texel, double, double v) {
    if (column == row.size()) {
      row = noise.row(v);
      column = 0;
    }
    texel *= 1.0F + strength * row[column++];
  });
}

void Canvas::paint(const Area& area, const std::function<double(double u_m, double v_m)>& albedo) {
  each(area, [&](float& texel, double u, double v) { texel = static_cast<float>(albedo(u, v)); });
}

}  // namespace glint::synth
