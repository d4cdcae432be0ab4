// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glint::synth {
namespace {

// Nearer than this is the surface that the ray starts from.
constexpr double kNearest_m = 1e-4;

}  // namespace

void Scene::add(const Quad& quad) {
  const Eigen::Vector3d normal = quad.along_u.cross(quad.along_v);
  quads_.push_back(quad);
  planes_.push_back({normal, normal.dot(quad.corner_m)});
}

void Scene::add_box(const Eigen::Vector3d& centre_of_base_m, const Eigen::Vector3d& size_m,
                    double yaw_rad, const std::shared_ptr<const Texture>& texture) {
  const Eigen::Matrix3d r = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d x = r.col(0);
  const Eigen::Vector3d y = r.col(1);
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d corner = centre_of_base_m - 0.5 * size_m.x() * x - 0.5 * size_m.y() * y;
  const Eigen::Vector3d opposite = corner + size_m.x() * x + size_m.y() * y;
  add({corner, x, z, size_m.x(), size_m.z(), texture});
  add({corner, y, z, size_m.y(), size_m.z(), texture});
  add({opposite, -x, z, size_m.x(), size_m.z(), texture});
  add({opposite, -y, z, size_m.y(), size_m.z(), texture});
  add({corner + size_m.z() * z, x, y, size_m.x(), size_m.y(), texture});
}

std::optional<Hit> Scene::cast(const Eigen::Vector3d& origin_m,
                               const Eigen::Vector3d& direction) const {
  Hit best;
  best.distance_m = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < quads_.size(); ++i) {
    const Plane& plane = planes_[i];
    const double approach = direction.dot(plane.normal);
    const double height_m = plane.offset_m - origin_m.dot(plane.normal);
    // Compared before dividing: most planes are behind the ray or farther than what it met already.
    const double sign = approach < 0 ? -1.0 : 1.0;
    if (sign * height_m < kNearest_m * std::abs(approach) ||
        sign * height_m >= best.distance_m * std::abs(approach)) {
      continue;
    }
    const double distance_m = height_m / approach;
    const Quad& quad = quads_[i];
    const Eigen::Vector3d local = origin_m + distance_m * direction - quad.corner_m;
    const double u_m = local.dot(quad.along_u);
    const double v_m = local.dot(quad.along_v);
    if (u_m < 0 || v_m < 0 || u_m > quad.width_m || v_m > quad.height_m) continue;
    best.distance_m = distance_m;
    best.normal = -sign * plane.normal;
    best.quad = &quad;
    best.u_m = u_m;
    best.v_m = v_m;
  }
  if (best.quad == nullptr) return std::nullopt;
  return best;
}

double Scene::distance_to_surface_m(const Eigen::Vector3d& point_m) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Quad& quad : quads_) {
    const Eigen::Vector3d local = point_m - quad.corner_m;
    const double u_m = std::clamp(local.dot(quad.along_u), 0.0, quad.width_m);
    const double v_m = std::clamp(local.dot(quad.along_v), 0.0, quad.height_m);
    nearest_m = std::min(nearest_m, (local - u_m * quad.along_u - v_m * quad.along_v).norm());
  }
  return nearest_m;
}

}  // namespace glint::synth
