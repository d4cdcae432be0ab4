// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/shell.hpp"

#include <numbers>

#include "pcap/synth/decoration.hpp"

namespace glint::synth {
namespace {

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kY = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

// Near-infrared photons off a white surface: under lamps, and in their shade.
constexpr double kLitPhotons = 90.0;
constexpr double kShadedPhotons = 40.0;

}  // namespace

void add_shell(std::vector<Surface>& surfaces, const Eigen::Vector3d& size_m, Random& random) {
  const double x_m = size_m.x();
  const double y_m = size_m.y();
  const double z_m = size_m.z();
  const auto wall = [&](const Eigen::Vector3d& corner_m, const Eigen::Vector3d& along,
                        double width_m) {
    surfaces.push_back({Rectangle{corner_m, along, kZ, width_m, z_m},
                        decorated_wall(width_m, z_m, random), kLitPhotons});
  };
  // u runs so that u x v points into the air: clockwise seen from above.
  wall({x_m, 0.0, 0.0}, -kX, x_m);
  wall({x_m, y_m, 0.0}, -kY, y_m);
  wall({0.0, y_m, 0.0}, kX, x_m);
  wall({0.0, 0.0, 0.0}, kY, y_m);
  surfaces.push_back({Rectangle{{0.0, 0.0, 0.0}, kX, kY, x_m, y_m},
                      floor_covering(x_m, y_m, random), kLitPhotons});
  surfaces.push_back({Rectangle{{0.0, y_m, z_m}, kX, -kY, x_m, y_m},
                      panel_ceiling(x_m, y_m, random), kShadedPhotons});
}

void add_box(std::vector<Surface>& surfaces, const Eigen::Vector3d& base_center_m,
             const Eigen::Vector3d& size_m, double yaw_rad, Random& random) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(yaw_rad, kZ).toRotationMatrix();
  const double x_m = size_m.x();
  const double y_m = size_m.y();
  const double z_m = size_m.z();
  const auto face = [&](const Eigen::Vector3d& corner_m, const Eigen::Vector3d& u_axis,
                        const Eigen::Vector3d& v_axis, double width_m, double height_m) {
    surfaces.push_back({Rectangle{base_center_m + turn * corner_m, turn * u_axis, turn * v_axis,
                                  width_m, height_m},
                        furniture_side(width_m, height_m, random), kShadedPhotons});
  };
  face({-0.5 * x_m, -0.5 * y_m, 0.0}, kX, kZ, x_m, z_m);
  face({0.5 * x_m, -0.5 * y_m, 0.0}, kY, kZ, y_m, z_m);
  face({0.5 * x_m, 0.5 * y_m, 0.0}, -kX, kZ, x_m, z_m);
  face({-0.5 * x_m, 0.5 * y_m, 0.0}, -kY, kZ, y_m, z_m);
  face({-0.5 * x_m, -0.5 * y_m, z_m}, kX, kY, x_m, y_m);
}

void add_cylinder(std::vector<Surface>& surfaces, const Eigen::Vector3d& base_m, double radius_m,
                  double height_m, Random& random) {
  surfaces.push_back({Cylinder{base_m, radius_m, height_m},
                      furniture_side(2.0 * std::numbers::pi * radius_m, height_m, random),
                      kShadedPhotons});
}

}  // namespace glint::synth
