// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace glint::synth {

/// A grey picture, row by row from its top; 255 is an albedo of 1. Value type.
struct Photograph {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Reads a binary PGM (P5) of 8 or 16 bits, at most 8192 x 8192. @throws InputError that names the
/// file and what is wrong with it.
Photograph load_pgm(const std::filesystem::path& file);

}  // namespace glint::synth
