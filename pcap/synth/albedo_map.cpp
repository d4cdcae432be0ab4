// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/albedo_map.hpp"

#include <algorithm>
#include <cmath>

namespace glint::synth {
namespace {

// The coarsest copy that a beam could need: texels of 2^6 times the finest.
constexpr std::size_t kMaxLevels = 7;

}  // namespace

AlbedoMap::AlbedoMap(const Canvas& canvas) : texel_m_(canvas.texel_m()) {
  Level finest{canvas.columns(), canvas.rows(), {}};
  finest.values.reserve(canvas.texels().size());
  for (const float albedo : canvas.texels()) {
    finest.values.push_back(
        static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(albedo, 0.0F, 1.0F))));
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
  const double wanted = std::log2(std::max(1.0, footprint_m / texel_m_));
  const auto index = std::min(static_cast<std::size_t>(std::lround(wanted)), levels_.size() - 1);
  const Level& level = levels_[index];
  const double texel_m = texel_m_ * static_cast<double>(1U << index);
  // Texel (i, j) has its centre at (i + 0.5, j + 0.5) texels.
  const double x = std::clamp(u_m / texel_m - 0.5, 0.0, level.width - 1.0);
  const double y = std::clamp(v_m / texel_m - 0.5, 0.0, level.height - 1.0);
  const int i = static_cast<int>(x);
  const int j = static_cast<int>(y);
  const int right = i + 1 < level.width ? 1 : 0;
  const int up = j + 1 < level.height ? level.width : 0;
  const std::uint8_t* at =
      &level.values[static_cast<std::size_t>(j) * static_cast<std::size_t>(level.width) +
                    static_cast<std::size_t>(i)];
  const double fx = x - i;
  const double fy = y - j;
  const double low = at[0] * (1.0 - fx) + at[right] * fx;
  const double high = at[up] * (1.0 - fx) + at[up + right] * fx;
  return (low * (1.0 - fy) + high * fy) / 255.0;
}

}  // namespace glint::synth
