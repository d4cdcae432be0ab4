// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "pcap/synth/scene/bounding_tree.hpp"
#include "pcap/synth/scene/surface.hpp"

namespace glint::synth {

/// What a ray sees: where, and on which surface.
struct Sighting {
  Hit hit;
  const Surface* surface = nullptr;  ///< Null when the ray meets nothing.
  bool moving = false;               ///< On a moving thing.
  /// The nearest place where a beam of the width asked for reaches over an edge, m: it may fall on
  /// more than the surface if that is not farther than the hit.
  double edge_m = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool at_edge() const {
    return edge_m <= hit.distance_m && edge_m < std::numeric_limits<double>::infinity();
  }
};

using Rays = std::array<Ray, kPacketRays>;
using Sightings = std::array<Sighting, kPacketRays>;

/// A rigid thing of many surfaces, in its own frame: a car, a tree, or all of a scene that stands
/// still. Immutable; thread-safe.
class Body {
 public:
  explicit Body(std::vector<Surface> surfaces);

  [[nodiscard]] const std::vector<Surface>& surfaces() const { return surfaces_; }
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }
  /// Casts rays, given in the body's frame: where one meets a surface before its sighting so far,
  /// that becomes the sighting. True if any did.
  bool cast(const Rays& rays, double beam_rad, Sightings& sightings) const;
  /// From a point to the nearest surface, m; for checks, not fast.
  [[nodiscard]] double distance_to_m(const Eigen::Vector3d& point_m) const;

 private:
  std::vector<Surface> surfaces_;
  BoundingTree tree_;
  Eigen::AlignedBox3d box_;
};

}  // namespace glint::synth
