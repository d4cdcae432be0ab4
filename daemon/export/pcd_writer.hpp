// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <span>

#include "slam/keyframe.hpp"

namespace glint::cli {

/// Writes points as a binary PCD (version 0.7) with x y z intensity (float32), map frame, m.
/// @throws InputError naming the file.
void write_pcd(const std::filesystem::path& file, std::span<const slam::MapPoint> points);

}  // namespace glint::cli
