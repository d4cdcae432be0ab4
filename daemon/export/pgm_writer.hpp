// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>

#include "slam/floor_plan.hpp"

namespace glint::cli {

/// Writes a plan as the map_server of ROS navigation reads it: a grey image (PGM; white is free,
/// black occupied, grey unknown; the top row is that of the greatest y), and beside it, with the
/// extension .yaml, its scale and origin in the map frame. Returns the latter's name.
/// @throws InputError naming the file.
std::filesystem::path write_floor_plan(const std::filesystem::path& file,
                                       const slam::FloorPlanImage& plan);

}  // namespace glint::cli
