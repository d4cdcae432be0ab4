// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <vector>

#include "pcap/synth/random.hpp"
#include "pcap/synth/surface.hpp"

namespace glint::synth {

/// The six inner faces of a block of air from the origin to `size_m` (x, y, z): four walls, floor
/// and ceiling, each decorated; what a corridor and a room are inside of.
void add_shell(std::vector<Surface>& surfaces, const Eigen::Vector3d& size_m, Random& random);

/// A box of furniture that stands on the floor, turned about z: four sides and the top.
void add_box(std::vector<Surface>& surfaces, const Eigen::Vector3d& base_center_m,
             const Eigen::Vector3d& size_m, double yaw_rad, Random& random);

/// A pillar or bin.
void add_cylinder(std::vector<Surface>& surfaces, const Eigen::Vector3d& base_m, double radius_m,
                  double height_m, Random& random);

}  // namespace glint::synth
