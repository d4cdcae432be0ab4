// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/xyz_lut.hpp"
#include "slam/scan_images.hpp"

namespace glint::slam {

struct PlaneFeatureOptions {
  /// LOAM's curvature: squared length of the sum of the differences to ten neighbours on the ring,
  /// m^2. Points below it lie on a surface.
  double largest_curvature_m2 = 0.1;
  /// About so many points are kept; the voxels that thin them out are sized to give this number.
  int wanted_points = 1800;
  /// Of a voxel's points that is kept which was measured first; else any of them. The first ones
  /// lie towards the beams' turning: surfaces that average them come out bent.
  bool in_order = true;
  double smallest_voxel_m = 0.1;
  double largest_voxel_m = 2.0;
};

/// Picks points on surfaces from a scan: those whose neighbours on the same ring lie evenly around
/// them [Zhang & Singh 2014, "LOAM", sec. V-A], whatever the table of beams, thinned to one a
/// voxel. Thread-compatible; no allocation after the first scans.
class PlaneExtractor {
 public:
  PlaneExtractor(const SensorInfo& info, PlaneFeatureOptions options,
                 std::shared_ptr<const XyzLut> lut);

  /// Points on surfaces, m, in the sensor frame at the scan's reference time. Without poses of the
  /// columns the scan is taken as rigid. Valid until the next call.
  const std::vector<Eigen::Vector3f>& extract(const ScanImages& images,
                                              std::span<const Pose> T_reference_column = {});
  /// About so many points are taken from the next scans.
  void set_wanted(int points) { options_.wanted_points = points; }
  /// Edge of the voxels that thinned the last scan.
  [[nodiscard]] double voxel_m() const { return voxel_m_; }

 private:
  void place_columns(std::span<const Pose> T_reference_column);
  void fill_ring(const ScanImages& images, int row);
  void take_flat_points();
  void thin_out();

  PlaneFeatureOptions options_;
  std::shared_ptr<const XyzLut> lut_;
  std::vector<int> shift_;
  double voxel_m_ = 0.4;

  bool rigid_ = true;
  std::vector<Eigen::Matrix3f> rotation_;  ///< A column's way to the reference time.
  std::vector<Eigen::Vector3f> translation_m_;
  std::vector<Eigen::Vector3f> ring_;  ///< One row's points in the order of measurement.
  std::vector<std::uint8_t> valid_;
  std::vector<Eigen::Vector3f> flat_;
  std::vector<Eigen::Vector3f> kept_;
  std::vector<std::uint64_t> voxel_table_;  ///< Open addressing; 0 is free.
};

}  // namespace glint::slam
