// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace glint::synth {
namespace {

std::vector<Surface> with_bodies(std::vector<Surface> surfaces,
                                 const std::vector<Placement>& placements) {
  for (const Placement& placement : placements) {
    for (Surface surface : placement.body->surfaces()) {
      surface.shape = moved(surface.shape, placement.T_world_body);
      surfaces.push_back(std::move(surface));
    }
  }
  return surfaces;
}

}  // namespace

Scene::Standing::Standing(std::shared_ptr<const Body> what, const Pose& T_world_body)
    : body(std::move(what)),
      to_world(T_world_body.rotation.toRotationMatrix()),
      to_body(to_world.transpose()),
      at_m(T_world_body.translation_m),
      center_m(to_world * body->box().center() + at_m),
      radius_m(0.5 * body->box().diagonal().norm()) {}

void Scene::Standing::cast(const Ray& ray, double beam_rad, Sighting& best) const {
  Rays local;
  local.fill({to_body * (ray.origin_m - at_m), to_body * ray.direction});
  Sightings sightings;
  sightings.fill(best);
  if (body->cast(local, beam_rad, sightings)) {
    best.hit = sightings[0].hit;
    best.hit.normal = to_world * best.hit.normal;
    best.surface = sightings[0].surface;
    best.moving = true;
  }
  best.edge_m = sightings[0].edge_m;
}

bool Scene::Standing::is_near(const Ray& ray, double limit_m) const {
  const Eigen::Vector3d to_center = center_m - ray.origin_m;
  const double abreast_m = to_center.dot(ray.direction);
  if (abreast_m < -radius_m || abreast_m - radius_m > limit_m) return false;
  return to_center.squaredNorm() - abreast_m * abreast_m < radius_m * radius_m;
}

double Scene::Standing::distance_to_m(const Eigen::Vector3d& point_m) const {
  return body->distance_to_m(to_body * (point_m - at_m));
}

Scene::Scene(std::vector<Surface> surfaces, const std::vector<Placement>& placements,
             std::vector<Mover> movers)
    : still_(with_bodies(std::move(surfaces), placements)), movers_(std::move(movers)) {}

Scene::Moment Scene::at(double t_s) const {
  Moment moment(*this);
  moment.moving_.reserve(movers_.size());
  for (const Mover& mover : movers_) {
    moment.moving_.emplace_back(mover.body, mover.T_world_body(t_s));
  }
  return moment;
}

Sightings Scene::cast(const std::array<const Moment*, kPacketRays>& moments, const Rays& rays,
                      double beam_rad) const {
  Sightings sightings;
  still_.cast(rays, beam_rad, sightings);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (const Standing& standing : moments[i]->moving_) {
      if (standing.is_near(rays[i], sightings[i].hit.distance_m)) {
        standing.cast(rays[i], beam_rad, sightings[i]);
      }
    }
  }
  return sightings;
}

Sighting Scene::Moment::cast(const Ray& ray) const {
  Rays rays;
  rays.fill(ray);
  std::array<const Moment*, kPacketRays> moments;
  moments.fill(this);
  return scene_.cast(moments, rays, 0.0)[0];
}

double Scene::Moment::distance_to_surface_m(const Eigen::Vector3d& point_m) const {
  double best_m = scene_.still_.distance_to_m(point_m);
  for (const Standing& standing : moving_) {
    best_m = std::min(best_m, standing.distance_to_m(point_m));
  }
  return best_m;
}

}  // namespace glint::synth
