// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <vector>

#include "pcap/synth/scene/surface.hpp"

// From metres on a plan to surfaces. z points up.
namespace glint::synth {

/// Near-infrared photons off a white surface: indoors under lamps and in their shade, outdoors in
/// the sun and beside it.
inline constexpr double kLampLight = 90.0;
inline constexpr double kLampShade = 40.0;
inline constexpr double kSunlight = 500.0;
inline constexpr double kSunShade = 260.0;

/// What a surface looks like: its picture and the light that falls on it.
struct Look {
  std::shared_ptr<const AlbedoMap> albedo;
  double ambient_photons = kSunShade;
};
/// A look for a face of this width and height, each its own.
using FaceLook = std::function<Look(double width_m, double height_m)>;

using Surfaces = std::vector<Surface>;

/// From one place to another, both its lower corners, so high: it is seen from the right hand of
/// who goes that way.
Rectangle upright(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double height_m);
/// A floor, seen from above: u along x, v along y.
Rectangle level(const Eigen::Vector3d& corner_m, double x_m, double y_m);
/// A ceiling over the same place, seen from below.
Rectangle overhead(const Eigen::Vector3d& corner_m, double x_m, double y_m);
/// Between four points of a plane, a rectangle's corners in order: u from a to b, v from a to d.
Rectangle between(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                  const Eigen::Vector3d& d_m);
/// A part of a rectangle, `lift_m` in front of it: for what hangs on it. Grazing rays still see
/// which is in front.
Rectangle part(const Rectangle& whole, const Area& area, double lift_m = 0.003);

void add(Surfaces& surfaces, const Shape& shape, const Look& look);
/// Something that lies on another surface.
void add_flush(Surfaces& surfaces, const Shape& shape, const Look& look);
/// A triangle of a plane that is painted as if it were a rectangle's part: u level, v up or north.
void add_triangle(Surfaces& surfaces, const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                  const Eigen::Vector3d& c_m, const Look& look);
/// Walls, floor and ceiling from inside.
struct ShellLook {
  FaceLook wall;
  FaceLook floor;
  FaceLook ceiling;
};
/// The six inner faces of a block of air from the origin to `size_m`.
void add_shell(Surfaces& surfaces, const Eigen::Vector3d& size_m, const ShellLook& look);
/// Upright walls along the legs of an open line of corners, seen from its right hand.
void add_walls(Surfaces& surfaces, const std::vector<Eigen::Vector3d>& corners_m, double height_m,
               const FaceLook& look);
/// A box that stands on the ground, turned about z: four sides and the top.
void add_box(Surfaces& surfaces, const Eigen::Vector3d& base_center_m,
             const Eigen::Vector3d& size_m, double yaw_rad, const FaceLook& look);
void add_box(Surfaces& surfaces, const Eigen::Vector3d& base_center_m,
             const Eigen::Vector3d& size_m, double yaw_rad, const Look& look);
/// A pillar: an upright cylinder with a flat top.
void add_pillar(Surfaces& surfaces, const Eigen::Vector3d& base_m, double radius_m, double height_m,
                const FaceLook& look);

}  // namespace glint::synth
