// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <vector>

namespace glint::synth {

/// What a control point holds: the carrier's place and attitude (m, rad), its speed as a share of
/// what is usual for it, and how far it has woken up since the start (0 to 1).
enum ControlRow { kX, kY, kZ, kHeading, kPitch, kRoll, kPace, kAwake, kControlRows };
using Control = Eigen::Matrix<double, kControlRows, 1>;

/// A uniform quintic B-spline in time whose control points, from some on, repeat for ever. Before
/// the first of them it stays there. Immutable, thread-safe.
class ControlTable {
 public:
  /// Control point k acts around `k * interval_s`. Those from `repeat_from` on follow each other
  /// round and round, each time with `turn_rad` more heading.
  ControlTable(std::vector<Control> controls, std::size_t repeat_from, double interval_s,
               double turn_rad);

  [[nodiscard]] Control at(double t_s) const;

 private:
  [[nodiscard]] Control control(std::int64_t index) const;

  const std::vector<Control> controls_;
  const std::int64_t repeat_from_;
  const double interval_s_;
  const double turn_rad_;
};

}  // namespace glint::synth
