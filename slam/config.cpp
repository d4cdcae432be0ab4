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
    config.deskew = false;
    config.orb_upright = false;
    config.plane_neighbours = 3;
    return config;
  }
  throw InputError(fmt::format("unknown preset '{}': choose 'paper' or 'full'", name));
}

}  // namespace glint::slam
