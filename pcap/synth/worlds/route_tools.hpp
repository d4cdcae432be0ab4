// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcap/synth/motion/route.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {

/// Length of the legs, that back to the start of a closed route included, m.
double length_m(const Route& route);
/// Level distance from a place to the nearest leg, m.
double distance_to_route_m(const Route& route, const Eigen::Vector2d& place_m);
/// Points every `step_m` along the legs.
std::vector<Eigen::Vector3d> places_along(const Route& route, double step_m);
/// Begins a closed route at any of its points and goes round either way.
void start_anywhere(Route& route, Random& random);

/// A closed way round a place, half-way between a rectangle's and an ellipse's, `half_x_m` and
/// `half_y_m` from the middle, straying by up to `stray_m`; begun anywhere, in either direction.
Route ring_route(const Eigen::Vector2d& middle_m, double half_x_m, double half_y_m, int points,
                 double stray_m, Random& random);
/// From one place to another, with a point about every `step_m`, that strays to either side by up
/// to `stray_m`.
Route straying_route(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double step_m,
                     double stray_m, Random& random);

}  // namespace glint::synth
