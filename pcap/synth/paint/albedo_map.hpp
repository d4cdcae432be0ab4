// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <vector>

#include "pcap/synth/paint/canvas.hpp"

namespace glint::synth {

/// What a surface looks like to a beam of any width: a picture of its albedo and ever coarser
/// copies of it, so that a far beam sees the mean over its footprint and not a random spot.
/// Immutable; thread-safe.
class AlbedoMap {
 public:
  /// Beyond the picture's edges it goes on as the canvas says: a small picture that repeats serves
  /// large surfaces.
  explicit AlbedoMap(const Canvas& canvas);

  /// Mean albedo (0 to 1) over about `footprint_m` around a place (m).
  [[nodiscard]] double sample(double u_m, double v_m, double footprint_m) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> values;  ///< 255 is an albedo of 1.
  };
  static Level halved(const Level& fine);

  double texels_per_m_;
  Edges edges_;
  std::vector<Level> levels_;  ///< Each half as fine as the one before.
};

}  // namespace glint::synth
