// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/sensor_info.hpp"

namespace glint::slam {

/// Where a point appears in a scan's images: the inverse of XyzLut. Immutable; any thread.
class ImageProjection {
 public:
  explicit ImageProjection(const SensorInfo& info);

  /// A place between the pixels of a DESTAGGERED image: `share_below` of the way from row `row` to
  /// the row next below it.
  struct Place {
    double azimuth_rad = 0.0;
    int row = 0;  ///< Of rows ordered by altitude, the highest first.
    double share_below = 0.0;
  };
  /// False where no row looks. `point_m` in the sensor frame when its column was measured.
  [[nodiscard]] bool project(const Eigen::Vector3d& point_m, Place& place) const;
  /// Number of the column that measured a place (measurement id).
  [[nodiscard]] int column_at(const Place& place) const;

  struct Sample {
    float value = 0.0F;
    /// Of the value by the point's position, 1/m, sensor frame.
    Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
  };
  /// Between four pixels of a DESTAGGERED image. False where project() is.
  [[nodiscard]] bool sample(const Image<std::uint8_t>& image, const Eigen::Vector3d& point_m,
                            Sample& sample) const;
  /// Values at evenly spaced places on the line from `first_m` to `last_m`. False where any is not
  /// in the image.
  [[nodiscard]] bool values_between(const Image<std::uint8_t>& image,
                                    const Eigen::Vector3d& first_m, const Eigen::Vector3d& last_m,
                                    std::span<float> values) const;
  /// The range that is measured nearest to that place, m; 0: no return, or no row looks there.
  [[nodiscard]] double range_near_m(const Image<std::uint32_t>& range_mm,
                                    const Eigen::Vector3d& point_m) const;
  /// From where ranges are measured, about.
  [[nodiscard]] double range_of_m(const Eigen::Vector3d& point_m) const {
    return to_lidar(point_m).norm();
  }

 private:
  [[nodiscard]] Eigen::Vector3d to_lidar(const Eigen::Vector3d& point_m) const {
    return rotation_.transpose() * (point_m - offset_m_);
  }
  struct Line {
    float value;
    float slope;  ///< A column.
  };
  struct Bearing {
    double azimuth_rad;
    double altitude_rad;
  };
  [[nodiscard]] Bearing bearing_of(const Eigen::Vector3d& point_m) const;
  [[nodiscard]] bool place_of(const Bearing& bearing, Place& place) const;
  [[nodiscard]] Line in_row(const Image<std::uint8_t>& image, int ordered_row,
                            double azimuth_rad) const;
  /// Column of the destaggered image, between 0 and its width.
  [[nodiscard]] double column_in(int ordered_row, double azimuth_rad) const;

  int columns_;
  Eigen::Matrix3d rotation_;          ///< T_sensor_lidar.
  Eigen::Vector3d offset_m_;          ///< The lidar's centre, sensor frame.
  double origin_m_;                   ///< Of the beams, from the lidar's axis.
  std::vector<int> rows_;             ///< The highest first.
  std::vector<double> altitude_rad_;  ///< Of these.
  /// Of these: column that looks to azimuth 0.
  std::vector<double> zero_column_;
  std::vector<int> shift_;  ///< Of these.
};

}  // namespace glint::slam
