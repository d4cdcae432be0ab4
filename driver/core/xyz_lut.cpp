// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/xyz_lut.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

#include "driver/core/destagger.hpp"

namespace glint {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr double kMetresPerMillimetre = 0.001;

}  // namespace

XyzLut::XyzLut(const SensorInfo& info)
    : rows_(info.pixels_per_column), columns_(info.columns_per_frame) {
  const auto pixels = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_);
  direction_.reserve(pixels);
  offset_.reserve(pixels);
  // The beam's origin circles the lidar's axis; measured ranges include the way out to it.
  const double origin_x_mm = info.beam_to_lidar(0, 3);
  const double origin_z_mm = info.beam_to_lidar(2, 3);
  const double origin_mm = std::hypot(origin_x_mm, origin_z_mm);
  const Eigen::Matrix3d rotation = info.lidar_to_sensor.topLeftCorner<3, 3>();
  const Eigen::Vector3d translation_mm = info.lidar_to_sensor.topRightCorner<3, 1>();
  for (int r = 0; r < rows_; ++r) {
    const auto row = static_cast<std::size_t>(r);
    const double azimuth_rad = -info.beam_azimuth_deg[row] * kRadiansPerDegree;
    const double altitude_rad = info.beam_altitude_deg[row] * kRadiansPerDegree;
    for (int m = 0; m < columns_; ++m) {
      const double encoder_rad = 2.0 * std::numbers::pi * (1.0 - static_cast<double>(m) / columns_);
      const double angle_rad = encoder_rad + azimuth_rad;
      const Eigen::Vector3d beam(std::cos(angle_rad) * std::cos(altitude_rad),
                                 std::sin(angle_rad) * std::cos(altitude_rad),
                                 std::sin(altitude_rad));
      const Eigen::Vector3d origin_point_mm(origin_x_mm * std::cos(encoder_rad),
                                            origin_x_mm * std::sin(encoder_rad), origin_z_mm);
      const Eigen::Vector3d start_mm = origin_point_mm - origin_mm * beam;
      direction_.emplace_back(kMetresPerMillimetre * (rotation * beam));
      offset_.emplace_back(kMetresPerMillimetre * (rotation * start_mm + translation_mm));
    }
  }
}

void XyzLut::destaggered_points(const Image<std::uint32_t>& range_mm,
                                std::span<const int> pixel_shift_by_row,
                                std::span<Eigen::Vector3d> out) const {
  assert(range_mm.rows == rows_ && range_mm.cols == columns_);
  assert(pixel_shift_by_row.size() == static_cast<std::size_t>(rows_));
  assert(out.size() == direction_.size());
  Eigen::Vector3d* to = out.data();
  for (int r = 0; r < rows_; ++r) {
    // The row is rotated about the column that comes first.
    const int first =
        staggered_column(0, pixel_shift_by_row[static_cast<std::size_t>(r)], columns_);
    for (int m = first; m < columns_; ++m) *to++ = point(r, m, range_mm(r, m));
    for (int m = 0; m < first; ++m) *to++ = point(r, m, range_mm(r, m));
  }
}

const Eigen::Vector3d& XyzLut::direction(int row, int column) const {
  return direction_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(column)];
}

const Eigen::Vector3d& XyzLut::offset(int row, int column) const {
  return offset_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(column)];
}

}  // namespace glint
