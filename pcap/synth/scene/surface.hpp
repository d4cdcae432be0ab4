// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "driver/core/pose.hpp"
#include "pcap/synth/paint/albedo_map.hpp"

namespace glint::synth {

/// A ray with unit direction (m, in the frame of what it is cast at).
struct Ray {
  Eigen::Vector3d origin_m;
  Eigen::Vector3d direction;
};

/// Where a ray meets a surface.
struct Hit {
  double distance_m = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Unit, away from the solid side.
  double u_m = 0.0;                                  ///< Place on the surface's albedo map.
  double v_m = 0.0;
};

/// A flat rectangle: corner + u * u_axis + v * v_axis, its normal u_axis x v_axis.
struct Rectangle {
  Eigen::Vector3d corner_m;
  Eigen::Vector3d u_axis;  ///< Unit.
  Eigen::Vector3d v_axis;  ///< Unit, at right angles to u_axis.
  double width_m;
  double height_m;
};

/// A flat triangle, its normal (b - a) x (c - a). A point p has its place on the albedo map at
/// (u_axis . p, v_axis . p), so that the triangles of a mesh can share one picture.
struct Triangle {
  Eigen::Vector3d a_m;
  Eigen::Vector3d b_m;
  Eigen::Vector3d c_m;
  Eigen::Vector3d u_axis;
  Eigen::Vector3d v_axis;
};

/// An upright cylinder's mantle, seen from outside; u runs round it, v up.
struct Cylinder {
  Eigen::Vector3d base_m;
  double radius_m;
  double height_m;
};

/// A level bore's mantle, seen from inside; u runs along it from its start, v round it from the
/// lowest line.
struct Tube {
  Eigen::Vector3d start_m;  ///< On the middle line.
  Eigen::Vector3d axis;     ///< Unit, level.
  double radius_m;
  double length_m;
};

using Shape = std::variant<Rectangle, Triangle, Cylinder, Tube>;

/// Where the ray meets the shape, if it does. A beam that widens by `beam_rad` around the ray may
/// reach over the shape's border, from inside or outside: then `edge_m` is lowered to the distance
/// of that place. The borders of triangles do not count, which are parts of meshes.
std::optional<Hit> intersect(const Shape& shape, const Ray& ray, double beam_rad, double& edge_m);
/// From a point to the nearest of the shape, m.
double distance_to(const Shape& shape, const Eigen::Vector3d& point_m);
/// The shape elsewhere. Cylinders and tubes may only be turned about z.
Shape moved(const Shape& shape, const Pose& T_world_shape);
/// A box around the shape, with room for beams that pass it closely.
Eigen::AlignedBox3d bounds(const Shape& shape);
/// Several such boxes that cover the shape together, closer than one would if it is large.
std::vector<Eigen::AlignedBox3d> cover(const Shape& shape);

/// A shape and what it looks like.
struct Surface {
  Shape shape;
  std::shared_ptr<const AlbedoMap> albedo;
  /// Ambient light that falls on it, near-infrared photons off a white surface.
  double ambient_photons = 60.0;
  /// Lies on another surface, as a poster does: no distance changes at its borders.
  bool flush = false;
};

}  // namespace glint::synth
