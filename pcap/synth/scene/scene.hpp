// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "driver/core/pose.hpp"
#include "pcap/synth/scene/body.hpp"

namespace glint::synth {

/// A body that stands still.
struct Placement {
  std::shared_ptr<const Body> body;
  Pose T_world_body;
};

/// A body that moves: where it is, `t_s` seconds after the start. The function must be smooth and
/// thread-safe.
struct Mover {
  std::shared_ptr<const Body> body;
  std::function<Pose(double t_s)> T_world_body;
};

/// The things of a world, ready for rays. Immutable: rays may be cast from any thread.
class Scene {
 public:
  /// `surfaces` are in the world frame.
  explicit Scene(std::vector<Surface> surfaces, const std::vector<Placement>& placements = {},
                 std::vector<Mover> movers = {});

  class Moment;
  /// The scene `t_s` seconds after the start. Refers to the scene.
  [[nodiscard]] Moment at(double t_s) const;

  /// What each ray sees first, at its own moment, in the middle of a beam that widens by
  /// `beam_rad`. Rays and sightings are in the world frame. Fast if the rays go side by side.
  [[nodiscard]] Sightings cast(const std::array<const Moment*, kPacketRays>& moments,
                               const Rays& rays, double beam_rad) const;

 private:
  /// A body where it stands, as rays need it.
  struct Standing {
    Standing(std::shared_ptr<const Body> what, const Pose& T_world_body);
    /// Casts at the body alone: what is nearer than the sighting so far becomes it.
    void cast(const Ray& ray, double beam_rad, Sighting& best) const;
    /// Whether the ray enters the ball around the body before `limit_m`.
    [[nodiscard]] bool is_near(const Ray& ray, double limit_m) const;
    [[nodiscard]] double distance_to_m(const Eigen::Vector3d& point_m) const;

    std::shared_ptr<const Body> body;
    Eigen::Matrix3d to_world;
    Eigen::Matrix3d to_body;
    Eigen::Vector3d at_m;
    Eigen::Vector3d center_m;
    double radius_m;
  };

  const Body still_;  ///< All that never moves, placed bodies too: one tree is faster than many.
  const std::vector<Mover> movers_;
};

/// A scene at one moment. Thread-safe.
class Scene::Moment {
 public:
  /// What a single ray sees.
  [[nodiscard]] Sighting cast(const Ray& ray) const;
  /// Distance from a point to the nearest surface, m; for checks, not fast.
  [[nodiscard]] double distance_to_surface_m(const Eigen::Vector3d& point_m) const;

 private:
  friend class Scene;
  explicit Moment(const Scene& scene) : scene_(scene) {}
  const Scene& scene_;
  std::vector<Standing> moving_;
};

}  // namespace glint::synth
