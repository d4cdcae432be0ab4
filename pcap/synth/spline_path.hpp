// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcap/synth/motion.hpp"

namespace glint::synth {

/// A smooth way on the ground near evenly spaced control points: a uniform quintic B-spline, whose
/// heading is still smooth in its third derivative. Immutable.
class SplinePath {
 public:
  /// At least 6 points, m. A closed path leads from the last point to the first; an open one ends
  /// near its third points, so it needs as many to spare at either end.
  SplinePath(std::vector<Eigen::Vector2d> control_points_m, bool closed);

  /// The place `way_m` along it (its length is exact to about the evenness of the points). A closed
  /// path goes round for ever.
  [[nodiscard]] PathPoint at(double way_m) const;
  [[nodiscard]] double length_m() const { return length_m_; }

 private:
  [[nodiscard]] const Eigen::Vector2d& control(int index) const;
  /// Position and derivative by the parameter, one unit per control point.
  void evaluate(double parameter, Eigen::Vector2d& position_m, Eigen::Vector2d& tangent) const;

  const std::vector<Eigen::Vector2d> points_m_;
  const bool closed_;
  int segments_;
  double length_m_ = 0.0;
};

}  // namespace glint::synth
