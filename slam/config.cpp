// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/config.hpp"

#include <fmt/format.h>

#include "driver/core/error.hpp"

namespace glint::slam {

SlamConfig preset_config(const std::string& name) {
  SlamConfig config;
  if (name == "full") return config;
  if (name == "paper") {
    config.preset = "paper";
    config.deskew = config.gyro = config.accelerometer = config.motion_prior = config.degeneracy =
        false;
    config.image_filter = config.ba_by_noise = config.moving_objects = false;
    config.patches = false;
    config.pgo_gravity = config.loop_consistency = config.thin_keyframes = false;
    config.orb_upright = false;
    config.loop_density = false;
    config.local_map_reach_m = 0.0;
    config.plane_map = "tree";
    config.plane_points = 1200;
    config.ba_weight = 1.0;
    config.plane_neighbours = 3;
    return config;
  }
  throw InputError(fmt::format("unknown preset '{}': choose 'paper' or 'full'", name));
}

}  // namespace glint::slam
