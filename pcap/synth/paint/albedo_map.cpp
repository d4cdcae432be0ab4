// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/paint/albedo_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace glint::synth {
namespace {

// The coarsest copy that a beam could need: texels of 2^6 times the finest.
constexpr std::size_t kMaxLevels = 7;

// The two texels that a place lies between, along one axis, and how near it is to the second.
struct Between {
  int first;
  int second;
  double weight;
};

// `at` in texels: texel i has its centre at i + 0.5. A repeating picture has 2^n texels.
Between between(double at, int count, Edges edges) {
  if (edges == Edges::kRepeat) {
    const double low = std::floor(at - 0.5);
    const auto first = static_cast<int>(low);
    return {first & (count - 1), (first + 1) & (count - 1), at - 0.5 - low};
  }
  const double inside = std::clamp(at - 0.5, 0.0, count - 1.0);
  const auto first = static_cast<int>(inside);
  return {first, std::min(first + 1, count - 1), inside - first};
}

}  // namespace

AlbedoMap::AlbedoMap(const Canvas& canvas)
    : texels_per_m_(1.0 / canvas.texel_m()), edges_(canvas.edges()) {
  Level finest{canvas.columns(), canvas.rows(), {}};
  finest.values.reserve(canvas.texels().size());
  for (const float albedo : canvas.texels()) {
    finest.values.push_back(
        static_cast<std::uint8_t>(255.0F * std::clamp(albedo, 0.0F, 1.0F) + 0.5F));
  }
  levels_.push_back(std::move(finest));
  while (levels_.size() < kMaxLevels && levels_.back().width > 1 && levels_.back().height > 1) {
    levels_.push_back(halved(levels_.back()));
  }
}

AlbedoMap::Level AlbedoMap::halved(const Level& fine) {
  Level coarse{fine.width / 2, fine.height / 2, {}};
  coarse.values.reserve(static_cast<std::size_t>(coarse.width) *
                        static_cast<std::size_t>(coarse.height));
  for (int y = 0; y < coarse.height; ++y) {
    const std::uint8_t* row =
        &fine.values[static_cast<std::size_t>(2 * y) * static_cast<std::size_t>(fine.width)];
    for (int x = 0; x < coarse.width; ++x, row += 2) {
      const int sum = row[0] + row[1] + row[fine.width] + row[fine.width + 1];
      coarse.values.push_back(static_cast<std::uint8_t>((sum + 2) / 4));
    }
  }
  return coarse;
}

double AlbedoMap::sample(double u_m, double v_m, double footprint_m) const {
  // The level whose texel is nearest to the footprint, by ratio: log2, rounded.
  const double texels = std::clamp(footprint_m * texels_per_m_, 1.0, 1e6);
  const auto wanted = std::bit_width(static_cast<unsigned>(texels * std::numbers::sqrt2)) - 1;
  const std::size_t index = std::min(static_cast<std::size_t>(wanted), levels_.size() - 1);
  const Level& level = levels_[index];
  const double scale = texels_per_m_ / static_cast<double>(1U << index);
  const Between u = between(u_m * scale, level.width, edges_);
  const Between v = between(v_m * scale, level.height, edges_);
  const auto row = [&](int y) {
    const std::uint8_t* at =
        &level.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width)];
    return at[u.first] + (at[u.second] - at[u.first]) * u.weight;
  };
  const double low = row(v.first);
  return (low + (row(v.second) - low) * v.weight) / 255.0;
}

}  // namespace glint::synth
