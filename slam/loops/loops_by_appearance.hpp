// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "slam/config.hpp"
#include "slam/loop_source.hpp"

namespace glint::slam {

/// The search for loops that the configuration asks for: a LoopDetector with its vocabulary, or an
/// empty function if slam.loops is off. @throws InputError if the vocabulary cannot be used.
LoopSource loops_by_appearance(const SlamConfig& config);

}  // namespace glint::slam
