// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <vector>

namespace glint::synth {

/// The way that a world offers to whoever moves through it: points on the ground, one leg between
/// each two. Value type.
struct Route {
  std::vector<Eigen::Vector3d> points_m;
  /// Round a closed route one goes for ever; at the end of an open one one turns on the spot and
  /// goes back.
  bool closed = false;
  /// Corners are rounded off with at most this radius, m.
  double corner_radius_m = 1.0;
  /// Free height over the way, m: a drone keeps well below it.
  double clear_height_m = 100.0;
};

}  // namespace glint::synth
