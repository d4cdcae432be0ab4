// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "slam/features.hpp"

namespace glint::slam {

/// A keyframe's strongest keypoints, as many as a Place takes, as the session file holds them: a
/// Zstandard frame of a byte 1 (the format's number), the count (uint32), then of all keypoints
/// after one another, little-endian: descriptors (4 uint64 each), points (3 float32, sensor frame,
/// m), columns and rows in the image (float32, px), angles (float32, rad), responses (float32) and
/// octaves (a byte). Any thread.
std::vector<std::byte> encode_features(const Features& features);

/// The keypoints in the order they had. What only the front end asks for, `columns` and
/// `raw_points_m`, stays empty. Null when the bytes are damaged.
std::optional<Features> decode_features(std::span<const std::byte> bytes);

}  // namespace glint::slam
