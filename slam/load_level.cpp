// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/load_level.hpp"

#include <algorithm>

namespace glint::slam {

LoadLevel load_level_of(std::string_view name) {
  const auto* const found = std::find(kLoadLevelNames.begin(), kLoadLevelNames.end(), name);
  return found == kLoadLevelNames.end() ? LoadLevel::kFull
                                        : static_cast<LoadLevel>(found - kLoadLevelNames.begin());
}

}  // namespace glint::slam
