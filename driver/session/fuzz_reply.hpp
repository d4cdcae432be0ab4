// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <span>

namespace glint {

/// Takes arbitrary bytes for each of a sensor's answers, and runs them through everything that
/// reads one. Returns 0; for fuzzers.
int parse_reply_for_fuzzing(std::span<const std::uint8_t> bytes);

}  // namespace glint
