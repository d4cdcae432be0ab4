// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>
#include <vector>

#include "pcap/synth/bounding_tree.hpp"
#include "pcap/synth/surface.hpp"

namespace glint::synth {

/// What a ray sees: where, and on which surface.
struct Sighting {
  Hit hit;
  const Surface* surface = nullptr;
};

/// The surfaces of a world, ready for rays. Immutable: rays may be cast from any thread.
class Scene {
 public:
  explicit Scene(std::vector<Surface> surfaces);

  /// The nearest surface along the ray, if any.
  [[nodiscard]] std::optional<Sighting> cast(const Ray& ray) const;
  /// The surface nearest to a point; for checks, not fast.
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& point_m) const;
  /// Distance from a point to the nearest surface, m: how far a measured point is off.
  [[nodiscard]] double distance_to_surface_m(const Eigen::Vector3d& point_m) const;
  [[nodiscard]] const std::vector<Surface>& surfaces() const { return surfaces_; }

 private:
  std::vector<Surface> surfaces_;
  BoundingTree tree_;
};

}  // namespace glint::synth
