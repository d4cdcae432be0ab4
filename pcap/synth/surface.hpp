// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <variant>

#include "pcap/synth/albedo_map.hpp"

namespace glint::synth {

/// A ray with unit direction (m, world frame).
struct Ray {
  Eigen::Vector3d origin_m;
  Eigen::Vector3d direction;
};

/// Where a ray meets a surface.
struct Hit {
  double distance_m = 0.0;
  Eigen::Vector3d normal;  ///< Unit, away from the solid side.
  double u_m = 0.0;        ///< Place on the surface's albedo map.
  double v_m = 0.0;
};

/// How far a point is from a surface: positive on the side that the normal points to.
struct Nearest {
  double distance_m = 0.0;
  Eigen::Vector3d normal;
};

/// A flat rectangle: corner + u * u_axis + v * v_axis, its normal u_axis x v_axis.
struct Rectangle {
  Eigen::Vector3d corner_m;
  Eigen::Vector3d u_axis;  ///< Unit.
  Eigen::Vector3d v_axis;  ///< Unit, at right angles to u_axis.
  double width_m;
  double height_m;
};

/// An upright cylinder's mantle, seen from outside; u runs round it, v up.
struct Cylinder {
  Eigen::Vector3d base_m;
  double radius_m;
  double height_m;
};

using Shape = std::variant<Rectangle, Cylinder>;

std::optional<Hit> intersect(const Shape& shape, const Ray& ray);
Nearest nearest(const Shape& shape, const Eigen::Vector3d& point_m);
Eigen::AlignedBox3d bounds(const Shape& shape);

/// A shape and what it looks like.
struct Surface {
  Shape shape;
  std::shared_ptr<const AlbedoMap> albedo;
  /// Ambient light that falls on it, near-infrared photons off a white surface.
  double ambient_photons = 60.0;
};

}  // namespace glint::synth
