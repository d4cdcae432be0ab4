// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "slam/keyframe.hpp"

namespace glint::slam {

/// What coordinates are rounded to, m: less than half of what a lidar's ranges waver by.
constexpr double kPointQuantum_m = 0.01;

/// A keyframe's points as the session file holds them: a Zstandard frame of a byte 1 (the format's
/// number), the count (uint32), then x, y and z (each point's difference to the one before it, in
/// kPointQuantum_m, zigzag, seven bits a byte, low bits first) and the intensities (a byte each).
/// Points that are not finite, or farther than 1000 km, are left out. Any thread.
std::vector<std::byte> encode_points(std::span<const MapPoint> points);

/// Points in their order, to half of kPointQuantum_m and half a step of intensity. Null when the
/// bytes are damaged.
std::optional<std::vector<MapPoint>> decode_points(std::span<const std::byte> bytes);

}  // namespace glint::slam
