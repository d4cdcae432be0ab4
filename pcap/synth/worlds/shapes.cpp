// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/worlds/shapes.hpp"

#include <cmath>
#include <numbers>

namespace glint::synth {
namespace {

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kY = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

}  // namespace

Rectangle upright(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double height_m) {
  const Eigen::Vector3d along_m = to_m - from_m;
  return {from_m, along_m.normalized(), kZ, along_m.norm(), height_m};
}

Rectangle level(const Eigen::Vector3d& corner_m, double x_m, double y_m) {
  return {corner_m, kX, kY, x_m, y_m};
}

Rectangle overhead(const Eigen::Vector3d& corner_m, double x_m, double y_m) {
  return {corner_m + y_m * kY, kX, -kY, x_m, y_m};
}

Rectangle between(const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                  const Eigen::Vector3d& d_m) {
  const Eigen::Vector3d u_m = b_m - a_m;
  const Eigen::Vector3d v_m = d_m - a_m;
  return {a_m, u_m.normalized(), v_m.normalized(), u_m.norm(), v_m.norm()};
}

Rectangle part(const Rectangle& whole, const Area& area, double lift_m) {
  const Eigen::Vector3d normal = whole.u_axis.cross(whole.v_axis);
  return {whole.corner_m + area.u_m * whole.u_axis + area.v_m * whole.v_axis + lift_m * normal,
          whole.u_axis, whole.v_axis, area.width_m, area.height_m};
}

void add(Surfaces& surfaces, const Shape& shape, const Look& look) {
  surfaces.push_back({shape, look.albedo, look.ambient_photons});
}

void add_flush(Surfaces& surfaces, const Shape& shape, const Look& look) {
  add(surfaces, shape, look);
  surfaces.back().flush = true;
}

void add_triangle(Surfaces& surfaces, const Eigen::Vector3d& a_m, const Eigen::Vector3d& b_m,
                  const Eigen::Vector3d& c_m, const Look& look) {
  const Eigen::Vector3d normal = (b_m - a_m).cross(c_m - a_m).normalized();
  const Eigen::Vector3d u_axis =
      std::hypot(normal.x(), normal.y()) > 1e-6 ? kZ.cross(normal).normalized() : kX;
  add(surfaces, Triangle{a_m, b_m, c_m, u_axis, normal.cross(u_axis)}, look);
}

void add_walls(Surfaces& surfaces, const std::vector<Eigen::Vector3d>& corners_m, double height_m,
               const FaceLook& look) {
  for (std::size_t i = 0; i + 1 < corners_m.size(); ++i) {
    const Rectangle wall = upright(corners_m[i], corners_m[i + 1], height_m);
    add(surfaces, wall, look(wall.width_m, wall.height_m));
  }
}

void add_shell(Surfaces& surfaces, const Eigen::Vector3d& size_m, const ShellLook& look) {
  const double x = size_m.x();
  const double y = size_m.y();
  // Clockwise seen from above, so that the air is on the right.
  add_walls(surfaces, {{0, 0, 0}, {0, y, 0}, {x, y, 0}, {x, 0, 0}, {0, 0, 0}}, size_m.z(),
            look.wall);
  add(surfaces, level({0, 0, 0}, x, y), look.floor(x, y));
  add(surfaces, overhead({0, 0, size_m.z()}, x, y), look.ceiling(x, y));
}

void add_box(Surfaces& surfaces, const Eigen::Vector3d& base_center_m,
             const Eigen::Vector3d& size_m, double yaw_rad, const FaceLook& look) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(yaw_rad, kZ).toRotationMatrix();
  const double x = size_m.x();
  const double y = size_m.y();
  const auto face = [&](const Eigen::Vector3d& corner_m, const Eigen::Vector3d& u_axis,
                        const Eigen::Vector3d& v_axis, double width_m, double height_m) {
    add(surfaces,
        Rectangle{base_center_m + turn * corner_m, turn * u_axis, turn * v_axis, width_m, height_m},
        look(width_m, height_m));
  };
  face({-0.5 * x, -0.5 * y, 0.0}, kX, kZ, x, size_m.z());
  face({0.5 * x, -0.5 * y, 0.0}, kY, kZ, y, size_m.z());
  face({0.5 * x, 0.5 * y, 0.0}, -kX, kZ, x, size_m.z());
  face({-0.5 * x, 0.5 * y, 0.0}, -kY, kZ, y, size_m.z());
  face({-0.5 * x, -0.5 * y, size_m.z()}, kX, kY, x, y);
}

void add_box(Surfaces& surfaces, const Eigen::Vector3d& base_center_m,
             const Eigen::Vector3d& size_m, double yaw_rad, const Look& look) {
  add_box(surfaces, base_center_m, size_m, yaw_rad, [&](double, double) { return look; });
}

void add_pillar(Surfaces& surfaces, const Eigen::Vector3d& base_m, double radius_m, double height_m,
                const FaceLook& look) {
  const double round_m = 2.0 * std::numbers::pi * radius_m;
  add(surfaces, Cylinder{base_m, radius_m, height_m}, look(round_m, height_m));
  // An octagon would be rounder; from below nobody sees the top at all.
  const double side_m = std::numbers::sqrt2 * radius_m;
  const Eigen::Vector3d corner_m = base_m + Eigen::Vector3d(-0.5 * side_m, -0.5 * side_m, height_m);
  add(surfaces, level(corner_m, side_m, side_m), look(side_m, side_m));
}

}  // namespace glint::synth
