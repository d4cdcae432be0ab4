// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace glint::synth {

/// The natural cubic spline through points at rising places: two continuous derivatives, no second
/// one at the ends. Outside it stays at its ends. Immutable, thread-safe.
template <int kDimension>
class CubicSpline {
 public:
  using Point = Eigen::Matrix<double, kDimension, 1>;

  /// At least two points.
  CubicSpline(std::vector<double> places, std::vector<Point> points)
      : places_(std::move(places)),
        points_(std::move(points)),
        bends_(points_.size(), Point::Zero()) {
    // The first derivative is continuous: a tridiagonal system for the second ones at the points,
    // solved by elimination.
    const std::size_t last = points_.size() - 1;
    std::vector<double> above(last, 0.0);
    for (std::size_t i = 1; i < last; ++i) {
      const double before = places_[i] - places_[i - 1];
      const double after = places_[i + 1] - places_[i];
      const double pivot = 2.0 * (before + after) - before * above[i - 1];
      const Point jump =
          (points_[i + 1] - points_[i]) / after - (points_[i] - points_[i - 1]) / before;
      above[i] = after / pivot;
      bends_[i] = (6.0 * jump - before * bends_[i - 1]) / pivot;
    }
    for (std::size_t i = last; i-- > 1;) bends_[i] -= above[i] * bends_[i + 1];
  }

  [[nodiscard]] Point at(double place) const {
    if (place <= places_.front()) return points_.front();
    if (place >= places_.back()) return points_.back();
    const auto next = std::upper_bound(places_.begin(), places_.end(), place);
    const auto right = static_cast<std::size_t>(next - places_.begin());
    const std::size_t left = right - 1;
    const double width = places_[right] - places_[left];
    const double b = (place - places_[left]) / width;
    const double a = 1.0 - b;
    return a * points_[left] + b * points_[right] +
           (width * width / 6.0) *
               (a * (a * a - 1.0) * bends_[left] + b * (b * b - 1.0) * bends_[right]);
  }

  [[nodiscard]] double end() const { return places_.back(); }

 private:
  std::vector<double> places_;
  std::vector<Point> points_;
  std::vector<Point> bends_;  ///< Second derivatives at the points.
};

}  // namespace glint::synth
