// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <vector>

namespace glint::synth {

/// A rectangle on a surface with an albedo of its own: a door, a poster, a sign. Value type.
struct Decal {
  enum class Pattern { kPlain, kBlocks, kText, kRings };
  double u_m = 0, v_m = 0;  ///< Lower left corner.
  double width_m = 0, height_m = 0;
  Pattern pattern = Pattern::kPlain;
  double bright = 0.8, dark = 0.1;  ///< Albedo of its two colours.
  std::uint64_t seed = 0;

  /// Albedo at a point inside, coordinates from its corner.
  [[nodiscard]] double albedo(double u, double v) const;
};

/// What a surface looks like: base albedo, joints of tiles or bricks, blotches, decals.
/// Coordinates (u, v) in metres on the surface. Immutable after set-up.
class Texture {
 public:
  struct Base {
    double albedo = 0.5;
    double blotch_contrast =
        0.1;                    ///< Share of the albedo by which blotches of three sizes vary it.
    double tile_width_m = 0.0;  ///< 0: no joints.
    double tile_height_m = 0.0;
    bool bricks = false;          ///< Every other row is shifted by half a tile.
    double tile_contrast = 0.15;  ///< Share by which whole tiles differ.
    std::uint64_t seed = 0;
  };

  explicit Texture(const Base& base) : base_(base) {}
  void add(const Decal& decal);
  /// True if a decal of this place and size would lie over another one.
  [[nodiscard]] bool occupied(const Decal& decal, double margin_m) const;

  /// Mean albedo, 0 to 1, over the footprint of a beam round a point: its half widths along u and
  /// v.
  [[nodiscard]] double albedo(double u_m, double v_m, double half_u_m = 0.0,
                              double half_v_m = 0.0) const;

 private:
  [[nodiscard]] double blotches(double u_m, double v_m) const;
  [[nodiscard]] double albedo_at(double u_m, double v_m, double shade) const;
  [[nodiscard]] double base_albedo(double u_m, double v_m, double shade) const;

  Base base_;
  std::vector<Decal> decals_;
  std::vector<std::vector<std::uint32_t>> bins_;  ///< Decals that touch each metre of u.
};

}  // namespace glint::synth
