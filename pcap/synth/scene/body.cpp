// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/scene/body.hpp"

#include <cmath>
#include <limits>

namespace glint::synth {
namespace {

std::vector<BoundingTree::Item> items_of(const std::vector<Surface>& surfaces) {
  std::vector<BoundingTree::Item> items;
  items.reserve(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (const Eigen::AlignedBox3d& box : cover(surfaces[i].shape)) {
      items.push_back({box, static_cast<int>(i)});
    }
  }
  return items;
}

BoundingTree::Packet packet_of(const Rays& rays) {
  BoundingTree::Packet packet;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      packet.origin_m[axis][i] = static_cast<float>(rays[i].origin_m[k]);
      // No component is exactly zero, or a flat box would give 0 * infinity.
      const auto direction = static_cast<float>(rays[i].direction[k]);
      packet.inverse_direction[axis][i] = 1.0F / (std::abs(direction) < 1e-9F ? 1e-9F : direction);
    }
  }
  return packet;
}

}  // namespace

Body::Body(std::vector<Surface> surfaces)
    : surfaces_(std::move(surfaces)), tree_(items_of(surfaces_)) {
  for (const Surface& surface : surfaces_) box_.extend(bounds(surface.shape));
}

bool Body::cast(const Rays& rays, double beam_rad, Sightings& sightings) const {
  const BoundingTree::Packet packet = packet_of(rays);
  BoundingTree::Lanes limits_m{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    limits_m[i] = static_cast<float>(sightings[i].hit.distance_m);
  }
  bool any = false;
  tree_.walk(packet, limits_m, [&](int item) {
    const Surface& surface = surfaces_[static_cast<std::size_t>(item)];
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Sighting& best = sightings[i];
      double ignored_m = 0.0;
      const auto hit =
          intersect(surface.shape, rays[i], beam_rad, surface.flush ? ignored_m : best.edge_m);
      if (!hit || hit->distance_m >= best.hit.distance_m) continue;
      best.hit = *hit;
      best.surface = &surface;
      limits_m[i] = static_cast<float>(hit->distance_m);
      any = true;
    }
  });
  return any;
}

double Body::distance_to_m(const Eigen::Vector3d& point_m) const {
  double best_m = std::numeric_limits<double>::infinity();
  for (const Surface& surface : surfaces_) {
    if (bounds(surface.shape).exteriorDistance(point_m) > best_m) continue;
    best_m = std::min(best_m, distance_to(surface.shape, point_m));
  }
  return best_m;
}

}  // namespace glint::synth
