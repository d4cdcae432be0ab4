// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/worlds/world_builder.hpp"

#include <algorithm>

#include "pcap/synth/paint/decals.hpp"
#include "pcap/synth/paint/decoration.hpp"

namespace glint::synth {
namespace {

// Worlds of the same seed have nothing in common.
std::uint64_t key_of(std::string_view name) {
  std::uint64_t key = 0;
  for (const char c : name) key = hash_keys({key, static_cast<unsigned char>(c)});
  return key;
}

}  // namespace

WorldBuilder::WorldBuilder(const WorldOptions& options)
    : random_{options.seed, key_of(options.name)},
      photographs_(options.photographs),
      traffic_(options.traffic) {}

std::shared_ptr<const AlbedoMap> WorldBuilder::material(Material material, int variant) {
  auto& picture = materials_[{material, variant}];
  if (!picture) picture = make_material(material, random_);
  return picture;
}

void WorldBuilder::place(BodyPtr body, const Eigen::Vector3d& at_m, double yaw_rad) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  placements_.push_back({std::move(body), Pose{turn, at_m}});
}

void WorldBuilder::place_any(const Variants& variants, const Eigen::Vector3d& at_m,
                             double yaw_rad) {
  const int index = random_.below(static_cast<int>(variants.size()));
  place(variants[static_cast<std::size_t>(index)], at_m, yaw_rad);
}

void WorldBuilder::add_mover(BodyPtr body, std::function<Pose(double t_s)> T_world_body) {
  movers_.push_back({std::move(body), std::move(T_world_body)});
}

ShellLook WorldBuilder::decorated_shell() {
  return {[this](double width_m, double height_m) {
            return Look{decorated_wall(width_m, height_m, photographs_, random_), kLampLight};
          },
          [this](double width_m, double height_m) {
            return Look{floor_covering(width_m, height_m, random_), kLampLight};
          },
          [this](double width_m, double height_m) {
            return Look{panel_ceiling(width_m, height_m, random_), kLampShade};
          }};
}

void WorldBuilder::hang_poster(const Rectangle& wall, const Area& area, double light) {
  add_flush(part(wall, area), {poster(area.width_m, area.height_m, photographs_, random_), light});
}

void WorldBuilder::hang_sign(const Rectangle& wall, const Area& area, double light) {
  add_flush(part(wall, area), {sign(area.width_m, area.height_m, random_), light});
}

void WorldBuilder::hang_pictures(const Rectangle& wall, double from_m, double to_m, double apart_m,
                                 double light) {
  for (double u = from_m + random_.uniform(0.2, 1.0) * apart_m; u < to_m - 2.0;
       u += random_.uniform(0.4, 1.6) * apart_m) {
    const double kind = random_.uniform();
    if (kind < 0.55) {
      const double width_m = random_.uniform(0.45, 1.1);
      const double height_m = std::min(width_m * random_.uniform(0.8, 1.5), wall.height_m - 1.2);
      hang_poster(wall, {u, random_.uniform(0.8, 1.1), width_m, height_m}, light);
    } else if (kind < 0.7) {
      const Area area{u, random_.uniform(0.8, 1.0), random_.uniform(1.0, 1.8), 1.0};
      add_flush(part(wall, area), {notice_board(area.width_m, area.height_m, random_), light});
    } else {
      const double size_m = random_.uniform(0.3, 0.6);
      hang_sign(wall, {u, random_.uniform(1.2, 1.7), size_m, size_m}, light);
    }
  }
}

World WorldBuilder::finish(Route route, std::string motion) {
  return {Scene(std::move(surfaces_), placements_, std::move(movers_)), std::move(route),
          std::move(motion)};
}

}  // namespace glint::synth
