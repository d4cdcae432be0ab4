// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>

#include "driver/core/pose.hpp"

namespace glint::synth {

/// A closed way along a rectangle's edges with its corners rounded: what cars drive round a block,
/// and, drawn out, how somebody walks up and down a pavement. Value type.
class RoundWay {
 public:
  /// Along x and y from the centre; `radius_m` at most half the lesser side; then turned about z.
  /// Anticlockwise seen from above, or else clockwise.
  RoundWay(const Eigen::Vector3d& center_m, double x_m, double y_m, double radius_m,
           double yaw_rad = 0.0, bool clockwise = false);

  [[nodiscard]] double length_m() const;
  /// Where one is after so much way, x pointing ahead. Goes round for ever, also backwards.
  [[nodiscard]] Pose at(double way_m) const;

 private:
  Eigen::Vector3d center_m_;
  double straight_x_m_;  ///< Lengths of the straight pieces.
  double straight_y_m_;
  double radius_m_;
  double yaw_rad_;
  bool clockwise_;
};

}  // namespace glint::synth
