// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <vector>

#include "pcap/synth/canvas.hpp"

namespace glint::synth {

/// What a surface looks like to a beam of any width: a picture of its albedo and ever coarser
/// copies of it, so that a far beam sees the mean over its footprint and not a random spot.
/// Immutable.
class AlbedoMap {
 public:
  explicit AlbedoMap(const Canvas& canvas);

  /// Mean albedo (0 to 1) over about `footprint_m` around a place (m); beyond the picture's edges
  /// the edge goes on.
  [[nodiscard]] double sample(double u_m, double v_m, double footprint_m) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> values;  ///< 255 is an albedo of 1.
  };
  static Level halved(const Level& fine);

  double texel_m_;
  std::vector<Level> levels_;  ///< Each half as fine as the one before.
};

}  // namespace glint::synth
