// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint {

/// Tables that turn ranges into points: p_sensor = range_mm * direction + offset (m, sensor frame).
/// Derivation: sensor manual, "lidar range to XYZ". Built once per sensor; immutable.
class XyzLut {
 public:
  explicit XyzLut(const SensorInfo& info);

  /// Point (m, sensor frame) of STAGGERED pixel (row, column m). Zero for range 0.
  [[nodiscard]] Eigen::Vector3d point(int row, int column, std::uint32_t range_mm) const {
    if (range_mm == 0) return Eigen::Vector3d::Zero();
    const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(column);
    return direction_[i] * static_cast<double>(range_mm) + offset_[i];
  }
  /// The points of a whole scan, DESTAGGERED, in one pass over its STAGGERED ranges: out[r * W + c]
  /// is point(r, staggered_column(c, pixel_shift_by_row[r], W), its range). `range_mm` has the
  /// sensor's rows and columns, and `out` room for as many points.
  void destaggered_points(const Image<std::uint32_t>& range_mm,
                          std::span<const int> pixel_shift_by_row,
                          std::span<Eigen::Vector3d> out) const;
  /// Direction scaled to metres per millimetre of range, and offset in metres, of a staggered
  /// pixel.
  [[nodiscard]] const Eigen::Vector3d& direction(int row, int column) const;
  [[nodiscard]] const Eigen::Vector3d& offset(int row, int column) const;
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int columns() const { return columns_; }

 private:
  int rows_;
  int columns_;
  std::vector<Eigen::Vector3d> direction_;
  std::vector<Eigen::Vector3d> offset_;
};

}  // namespace glint
