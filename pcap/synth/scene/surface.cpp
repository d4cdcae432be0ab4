// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/scene/surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint::synth {
namespace {

// A surface nearer than this is the one that the ray starts from.
constexpr double kMinDistanceM = 1e-6;
// Beams pass things as closely as this.
constexpr double kBoxMarginM = 0.03;
// A larger rectangle or tube is covered by boxes around pieces of about this length.
constexpr double kPieceM = 8.0;

void note_edge(double distance_m, double& edge_m) { edge_m = std::min(edge_m, distance_m); }

std::optional<Hit> hit(const Rectangle& r, const Ray& ray, double beam_rad, double& edge_m) {
  const Eigen::Vector3d normal = r.u_axis.cross(r.v_axis);
  const Eigen::Vector3d to_corner = r.corner_m - ray.origin_m;
  const double distance_m = normal.dot(to_corner) / normal.dot(ray.direction);
  // Also refuses the NaN and the infinity of a ray that runs along the surface.
  if (!(distance_m > kMinDistanceM) || !std::isfinite(distance_m)) return std::nullopt;
  const Eigen::Vector3d on_surface = distance_m * ray.direction - to_corner;
  const double u_m = on_surface.dot(r.u_axis);
  const double v_m = on_surface.dot(r.v_axis);
  const double inside_m = std::min({u_m, r.width_m - u_m, v_m, r.height_m - v_m});
  if (std::abs(inside_m) < beam_rad * distance_m) note_edge(distance_m, edge_m);
  if (inside_m < 0.0) return std::nullopt;
  return Hit{distance_m, normal, u_m, v_m};
}

// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997).
std::optional<Hit> hit(const Triangle& t, const Ray& ray, double /*beam_rad*/, double& /*edge_m*/) {
  const Eigen::Vector3d ab = t.b_m - t.a_m;
  const Eigen::Vector3d ac = t.c_m - t.a_m;
  const Eigen::Vector3d p = ray.direction.cross(ac);
  const double inverse = 1.0 / ab.dot(p);
  if (!std::isfinite(inverse)) return std::nullopt;
  const Eigen::Vector3d to_origin = ray.origin_m - t.a_m;
  const double b = to_origin.dot(p) * inverse;
  if (b < 0.0 || b > 1.0) return std::nullopt;
  const Eigen::Vector3d q = to_origin.cross(ab);
  const double c = ray.direction.dot(q) * inverse;
  if (c < 0.0 || b + c > 1.0) return std::nullopt;
  const double distance_m = ac.dot(q) * inverse;
  if (distance_m < kMinDistanceM) return std::nullopt;
  const Eigen::Vector3d at_m = ray.origin_m + distance_m * ray.direction;
  return Hit{distance_m, ab.cross(ac).normalized(), t.u_axis.dot(at_m), t.v_axis.dot(at_m)};
}

std::optional<Hit> hit(const Cylinder& c, const Ray& ray, double beam_rad, double& edge_m) {
  const Eigen::Vector3d from_base = ray.origin_m - c.base_m;
  const Eigen::Vector2d o = from_base.head<2>();
  const Eigen::Vector2d d = ray.direction.head<2>();
  const double a = d.squaredNorm();
  if (a < 1e-18) return std::nullopt;
  const double b = o.dot(d);
  // Where the ray is nearest to the axis, and by how much it passes inside the mantle there.
  const double abreast_m = -b / a;
  const double passes_m = c.radius_m - std::abs(o.x() * d.y() - o.y() * d.x()) / std::sqrt(a);
  const double height_m = from_base.z() + abreast_m * ray.direction.z();
  const bool beside = height_m > 0.0 && height_m < c.height_m;
  if (abreast_m > 0.0 && beside && std::abs(passes_m) < beam_rad * abreast_m) {
    note_edge(abreast_m, edge_m);
  }
  if (passes_m < 0.0) return std::nullopt;
  // |o + t d|^2 = radius^2, the nearer solution: the outside.
  const double root = b * b - a * (o.squaredNorm() - c.radius_m * c.radius_m);
  const double distance_m = (-b - std::sqrt(std::max(0.0, root))) / a;
  const double v_m = from_base.z() + distance_m * ray.direction.z();
  if (distance_m < kMinDistanceM) return std::nullopt;
  const double inside_m = std::min(v_m, c.height_m - v_m);
  if (std::abs(inside_m) < beam_rad * distance_m) note_edge(distance_m, edge_m);
  if (inside_m < 0.0) return std::nullopt;
  const Eigen::Vector2d n = (o + distance_m * d) / c.radius_m;
  const double angle_rad = std::atan2(n.y(), n.x()) + std::numbers::pi;
  return Hit{distance_m, {n.x(), n.y(), 0.0}, angle_rad * c.radius_m, v_m};
}

std::optional<Hit> hit(const Tube& t, const Ray& ray, double /*beam_rad*/, double& /*edge_m*/) {
  const Eigen::Vector3d from_start = ray.origin_m - t.start_m;
  const Eigen::Vector3d o = from_start - from_start.dot(t.axis) * t.axis;
  const Eigen::Vector3d d = ray.direction - ray.direction.dot(t.axis) * t.axis;
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double root = b * b - a * (o.squaredNorm() - t.radius_m * t.radius_m);
  if (root < 0.0 || a < 1e-18) return std::nullopt;
  // The farther solution: the inside.
  const double distance_m = (-b + std::sqrt(root)) / a;
  const double u_m = (from_start + distance_m * ray.direction).dot(t.axis);
  if (distance_m < kMinDistanceM || u_m < 0.0 || u_m > t.length_m) return std::nullopt;
  const Eigen::Vector3d n = (o + distance_m * d) / t.radius_m;
  const Eigen::Vector3d sideways = t.axis.cross(Eigen::Vector3d::UnitZ());
  const double angle_rad = std::atan2(n.dot(sideways), -n.z()) + std::numbers::pi;
  return Hit{distance_m, -n, u_m, angle_rad * t.radius_m};
}

double distance(const Rectangle& r, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d p = point_m - r.corner_m;
  const double u_m = std::clamp(p.dot(r.u_axis), 0.0, r.width_m);
  const double v_m = std::clamp(p.dot(r.v_axis), 0.0, r.height_m);
  return (p - u_m * r.u_axis - v_m * r.v_axis).norm();
}

double distance_to_segment(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                           const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d way = to_m - from_m;
  const double share = std::clamp((point_m - from_m).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (point_m - from_m - share * way).norm();
}

double distance(const Triangle& t, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d normal = (t.b_m - t.a_m).cross(t.c_m - t.a_m).normalized();
  const auto left_of = [&](const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
    return normal.dot((to_m - from_m).cross(point_m - from_m)) >= 0.0;
  };
  if (left_of(t.a_m, t.b_m) && left_of(t.b_m, t.c_m) && left_of(t.c_m, t.a_m)) {
    return std::abs(normal.dot(point_m - t.a_m));
  }
  return std::min({distance_to_segment(t.a_m, t.b_m, point_m),
                   distance_to_segment(t.b_m, t.c_m, point_m),
                   distance_to_segment(t.c_m, t.a_m, point_m)});
}

double distance(const Cylinder& c, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d p = point_m - c.base_m;
  const double above_m = p.z() - std::clamp(p.z(), 0.0, c.height_m);
  return std::hypot(p.head<2>().norm() - c.radius_m, above_m);
}

double distance(const Tube& t, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d p = point_m - t.start_m;
  const double u_m = p.dot(t.axis);
  const double beyond_m = u_m - std::clamp(u_m, 0.0, t.length_m);
  return std::hypot((p - u_m * t.axis).norm() - t.radius_m, beyond_m);
}

Rectangle move(const Rectangle& r, const Pose& T) {
  return {T * r.corner_m, T.rotation * r.u_axis, T.rotation * r.v_axis, r.width_m, r.height_m};
}

// The place on the albedo map stays that of the unmoved point, up to a constant.
Triangle move(const Triangle& t, const Pose& T) {
  return {T * t.a_m, T * t.b_m, T * t.c_m, T.rotation * t.u_axis, T.rotation * t.v_axis};
}

Cylinder move(const Cylinder& c, const Pose& T) { return {T * c.base_m, c.radius_m, c.height_m}; }

Tube move(const Tube& t, const Pose& T) {
  return {T * t.start_m, T.rotation * t.axis, t.radius_m, t.length_m};
}

Eigen::AlignedBox3d box_of(const Rectangle& r) {
  Eigen::AlignedBox3d box(r.corner_m);
  box.extend(r.corner_m + r.width_m * r.u_axis);
  box.extend(r.corner_m + r.height_m * r.v_axis);
  box.extend(r.corner_m + r.width_m * r.u_axis + r.height_m * r.v_axis);
  return box;
}

Eigen::AlignedBox3d box_of(const Triangle& t) {
  return Eigen::AlignedBox3d(t.a_m).extend(t.b_m).extend(t.c_m);
}

Eigen::AlignedBox3d box_of(const Cylinder& c) {
  const Eigen::Vector3d radius(c.radius_m, c.radius_m, 0.0);
  return {c.base_m - radius, c.base_m + radius + Eigen::Vector3d(0.0, 0.0, c.height_m)};
}

Eigen::AlignedBox3d box_of(const Tube& t) {
  Eigen::AlignedBox3d box(t.start_m);
  box.extend(t.start_m + t.length_m * t.axis);
  const Eigen::Vector3d radius = Eigen::Vector3d::Constant(t.radius_m);
  return {box.min() - radius, box.max() + radius};
}

int pieces(double length_m) { return std::max(1, static_cast<int>(std::ceil(length_m / kPieceM))); }

// In parts that together are the shape.
std::vector<Shape> parts_of(const Shape& shape) { return {shape}; }

std::vector<Shape> parts_of(const Rectangle& r) {
  std::vector<Shape> parts;
  const int columns = pieces(r.width_m);
  const int rows = pieces(r.height_m);
  const double width_m = r.width_m / columns;
  const double height_m = r.height_m / rows;
  for (int i = 0; i < columns * rows; ++i) {
    const double u_m = width_m * (i % columns);
    const double v_m = height_m * (i / columns);
    parts.emplace_back(Rectangle{r.corner_m + u_m * r.u_axis + v_m * r.v_axis, r.u_axis, r.v_axis,
                                 width_m, height_m});
  }
  return parts;
}

std::vector<Shape> parts_of(const Tube& t) {
  std::vector<Shape> parts;
  const int count = pieces(t.length_m);
  const double length_m = t.length_m / count;
  for (int i = 0; i < count; ++i) {
    parts.emplace_back(Tube{t.start_m + i * length_m * t.axis, t.axis, t.radius_m, length_m});
  }
  return parts;
}

}  // namespace

std::optional<Hit> intersect(const Shape& shape, const Ray& ray, double beam_rad, double& edge_m) {
  return std::visit([&](const auto& s) { return hit(s, ray, beam_rad, edge_m); }, shape);
}

double distance_to(const Shape& shape, const Eigen::Vector3d& point_m) {
  return std::visit([&](const auto& s) { return distance(s, point_m); }, shape);
}

Shape moved(const Shape& shape, const Pose& T_world_shape) {
  return std::visit([&](const auto& s) { return Shape(move(s, T_world_shape)); }, shape);
}

Eigen::AlignedBox3d bounds(const Shape& shape) {
  const Eigen::AlignedBox3d box = std::visit([](const auto& s) { return box_of(s); }, shape);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kBoxMarginM);
  return {box.min() - margin, box.max() + margin};
}

std::vector<Eigen::AlignedBox3d> cover(const Shape& shape) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Shape& part : std::visit([](const auto& s) { return parts_of(s); }, shape)) {
    boxes.push_back(bounds(part));
  }
  return boxes;
}

}  // namespace glint::synth
