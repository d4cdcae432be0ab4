// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace glint::slam {

/// What a back end's map takes. Value type.
struct MapMemory {
  std::size_t bytes = 0;         ///< In memory, about: tiles, places, graph.
  std::uint64_t disk_bytes = 0;  ///< Set aside on the disk.
  bool full = false;             ///< More than it may take: nothing is added to map and places.
};

}  // namespace glint::slam
