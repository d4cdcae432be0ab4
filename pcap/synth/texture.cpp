// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/texture.hpp"

#include <algorithm>
#include <cmath>

#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

constexpr double kJoint_m = 0.012;

// A random number in [0, 1) for each point of a grid; called too often for hash_keys().
double lattice(std::uint64_t seed, std::int64_t i, std::int64_t j) {
  std::uint64_t z = seed ^ (static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ULL) ^
                    (static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4FULL);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

// Smooth noise in [-1, 1] whose features have the size of one unit.
double value_noise(std::uint64_t seed, double x, double y) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto i = static_cast<std::int64_t>(fx);
  const auto j = static_cast<std::int64_t>(fy);
  const double tx = x - fx;
  const double ty = y - fy;
  const double sx = tx * tx * (3 - 2 * tx);
  const double sy = ty * ty * (3 - 2 * ty);
  const double low = lattice(seed, i, j) * (1 - sx) + lattice(seed, i + 1, j) * sx;
  const double high = lattice(seed, i, j + 1) * (1 - sx) + lattice(seed, i + 1, j + 1) * sx;
  return 2.0 * (low * (1 - sy) + high * sy) - 1.0;
}

std::size_t bin_of(double u_m) { return static_cast<std::size_t>(std::max(0.0, std::floor(u_m))); }

// Lines of words: dashes of random length, with gaps between words and lines.
double text_albedo(const Decal& decal, double u, double v) {
  constexpr double kLine_m = 0.09;
  constexpr double kLetter_m = 0.05;
  const double margin_m = 0.08 * std::min(decal.width_m, decal.height_m);
  if (u < margin_m || v < margin_m || u > decal.width_m - margin_m ||
      v > decal.height_m - margin_m) {
    return decal.bright;
  }
  const auto line = static_cast<std::int64_t>(v / kLine_m);
  if (v - static_cast<double>(line) * kLine_m < 0.4 * kLine_m) return decal.bright;
  const auto letter = static_cast<std::int64_t>(u / kLetter_m);
  return lattice(decal.seed, letter, line) < 0.65 ? decal.dark : decal.bright;
}

}  // namespace

double Decal::albedo(double u, double v) const {
  switch (pattern) {
    case Pattern::kPlain:
      return dark;
    case Pattern::kBlocks: {
      const auto i = static_cast<std::int64_t>(5.0 * u / width_m);
      const auto j = static_cast<std::int64_t>(6.0 * v / height_m);
      return dark + (bright - dark) * lattice(seed, i, j);
    }
    case Pattern::kText:
      return text_albedo(*this, u, v);
    case Pattern::kRings: {
      const double r = std::hypot(u - 0.5 * width_m, v - 0.5 * height_m);
      return std::fmod(r / (0.12 * std::min(width_m, height_m)), 2.0) < 1.0 ? dark : bright;
    }
  }
  return bright;
}

void Texture::add(const Decal& decal) {
  const std::size_t last = bin_of(decal.u_m + decal.width_m);
  if (bins_.size() <= last) bins_.resize(last + 1);
  for (std::size_t bin = bin_of(decal.u_m); bin <= last; ++bin) {
    bins_[bin].push_back(static_cast<std::uint32_t>(decals_.size()));
  }
  decals_.push_back(decal);
}

bool Texture::occupied(const Decal& decal, double margin_m) const {
  return std::any_of(decals_.begin(), decals_.end(), [&](const Decal& other) {
    return decal.u_m < other.u_m + other.width_m + margin_m &&
           other.u_m < decal.u_m + decal.width_m + margin_m &&
           decal.v_m < other.v_m + other.height_m + margin_m &&
           other.v_m < decal.v_m + decal.height_m + margin_m;
  });
}

double Texture::blotches(double u_m, double v_m) const {
  return base_.blotch_contrast * (0.5 * value_noise(base_.seed, 0.4 * u_m, 0.4 * v_m) +
                                  0.3 * value_noise(base_.seed + 1, 2.1 * u_m, 2.1 * v_m) +
                                  0.2 * value_noise(base_.seed + 2, 9.0 * u_m, 9.0 * v_m));
}

double Texture::base_albedo(double u_m, double v_m, double shade) const {
  if (base_.tile_width_m > 0) {
    const double row = std::floor(v_m / base_.tile_height_m);
    const bool shifted = base_.bricks && static_cast<std::int64_t>(row) % 2 != 0;
    const double across_m = u_m + (shifted ? 0.5 * base_.tile_width_m : 0.0);
    const double column = std::floor(across_m / base_.tile_width_m);
    const bool joint = across_m - column * base_.tile_width_m < kJoint_m ||
                       v_m - row * base_.tile_height_m < kJoint_m;
    if (joint) return 0.5 * base_.albedo;
    shade += base_.tile_contrast * (2.0 * lattice(base_.seed + 3, static_cast<std::int64_t>(column),
                                                  static_cast<std::int64_t>(row)) -
                                    1.0);
  }
  return base_.albedo * (1.0 + shade);
}

double Texture::albedo_at(double u_m, double v_m, double shade) const {
  const std::size_t bin = bin_of(u_m);
  if (bin < bins_.size()) {
    for (auto it = bins_[bin].rbegin(); it != bins_[bin].rend(); ++it) {
      const Decal& decal = decals_[*it];
      const double u = u_m - decal.u_m;
      const double v = v_m - decal.v_m;
      if (u >= 0 && v >= 0 && u < decal.width_m && v < decal.height_m) return decal.albedo(u, v);
    }
  }
  return std::clamp(base_albedo(u_m, v_m, shade), 0.02, 0.98);
}

double Texture::albedo(double u_m, double v_m, double half_u_m, double half_v_m) const {
  // Blotches are far larger than a footprint: one sample does for all four.
  const double shade = blotches(u_m, v_m);
  return 0.25 * (albedo_at(u_m - half_u_m, v_m - half_v_m, shade) +
                 albedo_at(u_m + half_u_m, v_m - half_v_m, shade) +
                 albedo_at(u_m - half_u_m, v_m + half_v_m, shade) +
                 albedo_at(u_m + half_u_m, v_m + half_v_m, shade));
}

}  // namespace glint::synth
