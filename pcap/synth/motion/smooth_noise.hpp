// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cmath>
#include <cstdint>

#include "pcap/synth/motion/quintic_spline.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {

/// A random function of time, between -1 and 1, without beginning or end: a quintic B-spline whose
/// control points are hashes of their number. Value type, thread-safe.
class SmoothNoise {
 public:
  /// A control point every `interval_s`; `hold` of them in a row are alike, so that with 3 or more
  /// the function rests between its moves.
  SmoothNoise(std::uint64_t key, double interval_s, int hold = 1)
      : key_(key), interval_s_(interval_s), hold_(hold) {}

  [[nodiscard]] double at(double t_s) const {
    const double place = t_s / interval_s_;
    const double interval = std::floor(place);
    const auto weights = spline_weights(place - interval);
    auto index = static_cast<std::int64_t>(interval) - kSplineBefore;
    double sum = 0.0;
    for (const double weight : weights) sum += weight * control(index++);
    return sum;
  }

 private:
  [[nodiscard]] double control(std::int64_t index) const {
    const std::int64_t run = index >= 0 ? index / hold_ : -1 - (-1 - index) / hold_;
    Random random{key_, static_cast<std::uint64_t>(run)};
    return random.uniform(-1.0, 1.0);
  }

  std::uint64_t key_;
  double interval_s_;
  int hold_;
};

}  // namespace glint::synth
