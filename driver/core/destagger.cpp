// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/destagger.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace glint {

template <class T>
void destagger(const Image<T>& staggered, std::span<const int> pixel_shift_by_row, Image<T>& out) {
  assert(out.rows == staggered.rows && out.cols == staggered.cols);
  assert(static_cast<int>(pixel_shift_by_row.size()) == staggered.rows);
  for (int r = 0; r < staggered.rows; ++r) {
    const int shift = pixel_shift_by_row[static_cast<std::size_t>(r)];
    // Output column 0 was measured in this column: the row is rotated about it.
    const int first = staggered_column(0, shift, staggered.cols);
    const std::span<const T> in = staggered.row(r);
    std::rotate_copy(in.begin(), in.begin() + first, in.end(), out.row(r).begin());
  }
}

template void destagger(const Image<std::uint8_t>&, std::span<const int>, Image<std::uint8_t>&);
template void destagger(const Image<std::uint16_t>&, std::span<const int>, Image<std::uint16_t>&);
template void destagger(const Image<std::uint32_t>&, std::span<const int>, Image<std::uint32_t>&);
template void destagger(const Image<float>&, std::span<const int>, Image<float>&);
template void destagger(const Image<double>&, std::span<const int>, Image<double>&);
template void destagger(const Image<SensorTime>&, std::span<const int>, Image<SensorTime>&);

}  // namespace glint
