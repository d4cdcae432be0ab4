// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::slam {

/// Makes of a DESTAGGERED intensity image one that corners can be looked for in, wherever the light
/// is: beams that see more or less than their neighbours are evened out, then every pixel I becomes
///
///   128 + c (I - m) / sqrt(v + s^2 (m + 1)),
///
/// m and v being mean and variance in a window of 15 by 5 degrees around it, and m + 1 what the
/// variance of counted photons is. So contrast looks alike in the bright and in the dark, but never
/// does noise look like contrast.
///
/// Beams are compared where neighbours fall on one surface, and what is learned of them is kept
/// from scan to scan, so scans must come in order. Thread-compatible; no allocation after
/// construction.
class ImageFilter {
 public:
  explicit ImageFilter(const SensorInfo& info);

  /// All three images have the sensor's H x W. `range_mm`: 0 = no return. `brightness`: 1 to 255;
  /// where nothing came back the middle (128), so that holes are no corners.
  void apply(const Image<std::uint16_t>& intensity, const Image<std::uint32_t>& range_mm,
             Image<std::uint8_t>& brightness);

  /// By what each row's intensity is multiplied; H entries, 1 before the first scan.
  [[nodiscard]] std::span<const double> row_factors() const { return row_factors_; }

 private:
  /// Sums over the window's rows, for each column. Of whole numbers, hence exact.
  struct ColumnSums {
    std::vector<double> pixels, levels, squares;
  };
  /// Rows first to last (inclusive) of a window.
  struct Rows {
    int first, last;
  };

  void compare_beams(const Image<std::uint16_t>& intensity, const Image<std::uint32_t>& range_mm);
  void update_factors();
  void scale_rows(const Image<std::uint16_t>& intensity, const Image<std::uint32_t>& range_mm);
  void count_row(int row, double sign);
  void sum_along_row();
  void write_row(int row, std::span<std::uint8_t> out) const;

  const int half_columns_;  ///< The window has as many columns on either side.
  int trend_rows_;          ///< As many rows on either side tell a row's trend.
  std::vector<Rows> window_rows_;
  int scans_ = 0;
  std::vector<double> steps_;  ///< Logarithm of what row r + 1 sees more than row r; H - 1 entries.
  std::vector<double> offsets_;  ///< Of rows, from the first one's; H entries.
  std::vector<double> row_factors_;
  Image<float> levels_;  ///< Evened intensity in quarters, whole numbers; 0 = no return.
  Image<float> valid_;   ///< 1 where there is a return, else 0.
  ColumnSums columns_;
  ColumnSums windows_;  ///< Over the whole window of each pixel of a row.
};

}  // namespace glint::slam
