// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/keyframe.hpp"

namespace glint::slam {

/// Points as version 1 of the session file held them: seven bytes each, int16 x, y, z in
/// centimetres and the intensity as a byte. A rest that is no point is left out.
std::vector<MapPoint> points_of_version_1(std::span<const std::byte> bytes);

}  // namespace glint::slam
