// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/scene.hpp"

#include <cmath>
#include <limits>

namespace glint::synth {
namespace {

std::vector<Eigen::AlignedBox3d> boxes_of(const std::vector<Surface>& surfaces) {
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(surfaces.size());
  for (const Surface& surface : surfaces) boxes.push_back(bounds(surface.shape));
  return boxes;
}

}  // namespace

Scene::Scene(std::vector<Surface> surfaces)
    : surfaces_(std::move(surfaces)), tree_(boxes_of(surfaces_)) {}

std::optional<Sighting> Scene::cast(const Ray& ray) const {
  Sighting best;
  best.hit.distance_m = std::numeric_limits<double>::infinity();
  tree_.walk(ray.origin_m, ray.direction, [&](int item) {
    const Surface& surface = surfaces_[static_cast<std::size_t>(item)];
    const auto hit = intersect(surface.shape, ray);
    if (hit && hit->distance_m < best.hit.distance_m) best = {*hit, &surface};
    return best.hit.distance_m;
  });
  if (best.surface == nullptr) return std::nullopt;
  return best;
}

Nearest Scene::nearest(const Eigen::Vector3d& point_m) const {
  Nearest best{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero()};
  for (const Surface& surface : surfaces_) {
    const Nearest here = synth::nearest(surface.shape, point_m);
    if (std::abs(here.distance_m) < std::abs(best.distance_m)) best = here;
  }
  return best;
}

double Scene::distance_to_surface_m(const Eigen::Vector3d& point_m) const {
  return std::abs(nearest(point_m).distance_m);
}

}  // namespace glint::synth
