// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <span>

#include "driver/core/lidar_scan.hpp"

namespace glint {

/// out[r][(c + shift[r]) mod W] = in[r][c]. `out` must have the shape of `in` and not alias it.
template <class T>
void destagger(const Image<T>& staggered, std::span<const int> pixel_shift_by_row, Image<T>& out);

/// Column of the staggered scan in which pixel (row, c) of the destaggered image was measured.
inline int staggered_column(int destaggered_column, int shift, int columns) {
  const int m = (destaggered_column - shift) % columns;
  return m < 0 ? m + columns : m;
}

}  // namespace glint
