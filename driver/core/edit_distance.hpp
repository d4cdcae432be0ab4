// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <string_view>

namespace glint {

/// How many characters must be put in, taken out or replaced to make one text of the other: for
/// messages that name what was likely meant. Time and memory grow with the product of the sizes.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace glint
