// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <filesystem>
#include <span>

#include "slam/keyframe.hpp"

namespace glint::cli {

/// Writes points as LAS 1.2, point format 0: coordinates in millimetres from an offset, intensity
/// spread from 0-255 over 16 bits as the format asks for. Map frame, m; no coordinate system is
/// named, for the map has none. @throws InputError naming the file, also when there are more points
/// than LAS 1.2 can count (2^32).
void write_las(const std::filesystem::path& file, std::span<const slam::MapPoint> points);

}  // namespace glint::cli
