// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint::synth {
namespace {

// A surface nearer than this is the one that the ray starts from.
constexpr double kMinDistanceM = 1e-6;
// Flat things still need boxes with an inside.
constexpr double kBoxMarginM = 1e-6;

std::optional<Hit> hit(const Rectangle& r, const Ray& ray) {
  const Eigen::Vector3d normal = r.u_axis.cross(r.v_axis);
  const Eigen::Vector3d to_corner = r.corner_m - ray.origin_m;
  const double distance_m = normal.dot(to_corner) / normal.dot(ray.direction);
  // Also refuses the NaN and the infinity of a ray that runs along the surface.
  if (!(distance_m > kMinDistanceM) || !std::isfinite(distance_m)) return std::nullopt;
  const Eigen::Vector3d on_surface = distance_m * ray.direction - to_corner;
  const double u_m = on_surface.dot(r.u_axis);
  const double v_m = on_surface.dot(r.v_axis);
  if (u_m < 0.0 || u_m > r.width_m || v_m < 0.0 || v_m > r.height_m) return std::nullopt;
  return Hit{distance_m, normal, u_m, v_m};
}

std::optional<Hit> hit(const Cylinder& c, const Ray& ray) {
  const Eigen::Vector3d from_base = ray.origin_m - c.base_m;
  const Eigen::Vector2d o = from_base.head<2>();
  const Eigen::Vector2d d = ray.direction.head<2>();
  // |o + t d|^2 = radius^2, the nearer solution: the outside.
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double root = b * b - a * (o.squaredNorm() - c.radius_m * c.radius_m);
  if (root < 0.0 || a < 1e-18) return std::nullopt;
  const double distance_m = (-b - std::sqrt(root)) / a;
  const double v_m = from_base.z() + distance_m * ray.direction.z();
  if (distance_m < kMinDistanceM || v_m < 0.0 || v_m > c.height_m) return std::nullopt;
  const Eigen::Vector2d n = (o + distance_m * d) / c.radius_m;
  const double angle_rad = std::atan2(n.y(), n.x()) + std::numbers::pi;
  return Hit{distance_m, {n.x(), n.y(), 0.0}, angle_rad * c.radius_m, v_m};
}

Nearest nearest_to(const Rectangle& r, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d normal = r.u_axis.cross(r.v_axis);
  const Eigen::Vector3d p = point_m - r.corner_m;
  const double u_m = std::clamp(p.dot(r.u_axis), 0.0, r.width_m);
  const double v_m = std::clamp(p.dot(r.v_axis), 0.0, r.height_m);
  const double distance_m = (p - u_m * r.u_axis - v_m * r.v_axis).norm();
  return {std::copysign(distance_m, p.dot(normal)), normal};
}

Nearest nearest_to(const Cylinder& c, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d p = point_m - c.base_m;
  const double radius_m = p.head<2>().norm();
  const double outside_m = radius_m - c.radius_m;
  const double above_m = p.z() - std::clamp(p.z(), 0.0, c.height_m);
  const Eigen::Vector3d normal(p.x() / radius_m, p.y() / radius_m, 0.0);
  return {std::copysign(std::hypot(outside_m, above_m), outside_m), normal};
}

Eigen::AlignedBox3d box_of(const Rectangle& r) {
  Eigen::AlignedBox3d box(r.corner_m);
  box.extend(r.corner_m + r.width_m * r.u_axis);
  box.extend(r.corner_m + r.height_m * r.v_axis);
  box.extend(r.corner_m + r.width_m * r.u_axis + r.height_m * r.v_axis);
  return box;
}

Eigen::AlignedBox3d box_of(const Cylinder& c) {
  const Eigen::Vector3d radius(c.radius_m, c.radius_m, 0.0);
  return {c.base_m - radius, c.base_m + radius + Eigen::Vector3d(0.0, 0.0, c.height_m)};
}

}  // namespace

std::optional<Hit> intersect(const Shape& shape, const Ray& ray) {
  if (const auto* rectangle = std::get_if<Rectangle>(&shape)) return hit(*rectangle, ray);
  return hit(std::get<Cylinder>(shape), ray);
}

Nearest nearest(const Shape& shape, const Eigen::Vector3d& point_m) {
  return std::visit([&](const auto& s) { return nearest_to(s, point_m); }, shape);
}

Eigen::AlignedBox3d bounds(const Shape& shape) {
  Eigen::AlignedBox3d box = std::visit([](const auto& s) { return box_of(s); }, shape);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kBoxMarginM);
  return {box.min() - margin, box.max() + margin};
}

}  // namespace glint::synth
