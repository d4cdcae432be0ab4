// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pcap/synth/paint/materials.hpp"
#include "pcap/synth/random.hpp"
#include "pcap/synth/worlds/shapes.hpp"
#include "pcap/synth/worlds/world.hpp"

namespace glint::synth {

using BodyPtr = std::shared_ptr<const Body>;
/// Bodies of one kind, each made differently, to be placed many times.
using Variants = std::vector<BodyPtr>;

/// Collects what a world is made of; what many things share is kept once. Thread-compatible.
class WorldBuilder {
 public:
  /// Refers to the options' photographs.
  explicit WorldBuilder(const WorldOptions& options);

  /// All of the world's randomness.
  Random& random() { return random_; }
  [[nodiscard]] std::span<const Photograph> photographs() const { return photographs_; }
  /// Times as many moving things as usual.
  [[nodiscard]] double traffic() const { return traffic_; }

  /// The material's picture number `variant`, made when first asked for.
  std::shared_ptr<const AlbedoMap> material(Material material, int variant = 0);

  /// What stands still and is there once, in the world frame.
  Surfaces& surfaces() { return surfaces_; }
  void add(const Shape& shape, const Look& look) { synth::add(surfaces_, shape, look); }
  void add_flush(const Shape& shape, const Look& look) { synth::add_flush(surfaces_, shape, look); }
  /// Something that stands still.
  void place(BodyPtr body, const Eigen::Vector3d& at_m, double yaw_rad);
  void place_any(const Variants& variants, const Eigen::Vector3d& at_m, double yaw_rad);
  void add_mover(BodyPtr body, std::function<Pose(double t_s)> T_world_body);

  /// Walls, floor and ceiling of a place where people live and work, each face another.
  ShellLook decorated_shell();
  /// Hangs a new picture on a wall with its lower left corner there.
  void hang_poster(const Rectangle& wall, const Area& area, double light);
  void hang_sign(const Rectangle& wall, const Area& area, double light);
  /// Posters, boards and signs at eye level, a few metres apart on average, for `from_m` to `to_m`
  /// along the wall.
  void hang_pictures(const Rectangle& wall, double from_m, double to_m, double apart_m,
                     double light);

  /// The world; the builder is used up.
  World finish(Route route, std::string motion);

 private:
  Random random_;
  std::span<const Photograph> photographs_;
  double traffic_;
  std::map<std::pair<Material, int>, std::shared_ptr<const AlbedoMap>> materials_;
  Surfaces surfaces_;
  std::vector<Placement> placements_;
  std::vector<Mover> movers_;
};

}  // namespace glint::synth
