// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstddef>

namespace glint::synth {

/// Control points that act on one place of a uniform quintic B-spline. Such a spline has four
/// continuous derivatives, and stays within what its control points span.
constexpr int kSplineSupport = 6;
/// How many of them lie before the one at the start of the interval.
constexpr int kSplineBefore = 2;

/// Their weights at `fraction` (0 to 1) of the interval; they add up to 1. By the recurrence of Cox
/// and de Boor.
inline std::array<double, kSplineSupport> spline_weights(double fraction) {
  std::array<double, kSplineSupport> weights{1.0};
  for (int degree = 1; degree < kSplineSupport; ++degree) {
    const double inverse = 1.0 / degree;
    double carried = 0.0;
    for (int i = 0; i < degree; ++i) {
      double& weight = weights[static_cast<std::size_t>(i)];
      const double share = weight * inverse;
      weight = carried + (i + 1 - fraction) * share;
      carried = (fraction + degree - 1 - i) * share;
    }
    weights[static_cast<std::size_t>(degree)] = carried;
  }
  return weights;
}

}  // namespace glint::synth
