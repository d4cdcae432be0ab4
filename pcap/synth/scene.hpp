// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "pcap/synth/texture.hpp"

namespace glint::synth {

/// A flat rectangle: corner + u * along_u + v * along_v, 0 <= u <= width_m, 0 <= v <= height_m.
struct Quad {
  Eigen::Vector3d corner_m;
  Eigen::Vector3d along_u;  ///< Unit vectors, at right angles.
  Eigen::Vector3d along_v;
  double width_m = 0;
  double height_m = 0;
  std::shared_ptr<const Texture> texture;
};

/// Where a ray meets the scene first.
struct Hit {
  double distance_m = 0;
  Eigen::Vector3d normal;  ///< Unit, towards the ray's origin.
  const Quad* quad = nullptr;
  double u_m = 0;
  double v_m = 0;
};

/// Everything that a sensor can see, in the world frame (z up). Immutable after set-up; cast() may
/// be called from any number of threads.
class Scene {
 public:
  void add(const Quad& quad);
  /// A box that stands on the ground, turned about z: five faces with one texture.
  void add_box(const Eigen::Vector3d& centre_of_base_m, const Eigen::Vector3d& size_m,
               double yaw_rad, const std::shared_ptr<const Texture>& texture);

  /// The first surface that a ray meets; `direction` is a unit vector.
  [[nodiscard]] std::optional<Hit> cast(const Eigen::Vector3d& origin_m,
                                        const Eigen::Vector3d& direction) const;
  /// Distance from a point to the nearest surface, m: how far a measured point is off.
  [[nodiscard]] double distance_to_surface_m(const Eigen::Vector3d& point_m) const;

 private:
  /// A quad's plane, for rays: normal * x = offset_m.
  struct Plane {
    Eigen::Vector3d normal;
    double offset_m;
  };
  std::vector<Quad> quads_;
  std::vector<Plane> planes_;  ///< One for each quad.
};

}  // namespace glint::synth
