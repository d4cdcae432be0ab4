// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/core/xyz_lut.hpp"
#include "slam/config.hpp"
#include "slam/scan_images.hpp"

namespace glint::slam {

/// A 256-bit binary descriptor (ORB).
using Descriptor = std::array<std::uint64_t, 4>;

/// The keypoints of one scan that have a return, with their 3-D points; entry i of each vector
/// belongs to keypoint i. Value type.
struct Features {
  struct Keypoint {
    float u_px = 0.0F;  ///< Column in the destaggered image.
    float v_px = 0.0F;  ///< Row.
    float angle_rad = 0.0F;
    int octave = 0;
    float response = 0.0F;  ///< Strength of the corner, comparable within one scan.
  };
  std::vector<Keypoint> keypoints;
  std::vector<Descriptor> descriptors;
  /// Sensor frame at the time the pixel was measured, m.
  std::vector<Eigen::Vector3d> raw_points_m;
  std::vector<int> columns;  ///< Measurement column of each pixel.
  /// Sensor frame at the scan's reference time, m; what is registered.
  std::vector<Eigen::Vector3d> points_m;

  [[nodiscard]] std::size_t size() const { return keypoints.size(); }
  void clear();
  /// Brings the points, each measured in its own column, to the scan's reference time.
  void deskew(std::span<const Pose> T_reference_column);
};

/// ORB on the intensity image, and the 3-D point of each keypoint from the same pixel
/// [Du & Beltrame 2023, sec. III-A]. Images of fewer than 64 rows are enlarged first, so that
/// descriptors have something to look at. Thread-compatible.
class FeatureExtractor {
 public:
  FeatureExtractor(const SensorInfo& info, const SlamConfig& config,
                   std::shared_ptr<const XyzLut> lut);
  ~FeatureExtractor();
  FeatureExtractor(const FeatureExtractor&) = delete;
  FeatureExtractor& operator=(const FeatureExtractor&) = delete;

  /// From the next image on at most so many keypoints are taken.
  void set_most(int keypoints);
  /// Fills everything but `points_m`, which is set to `raw_points_m`.
  void extract(const ScanImages& images, Features& features);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace glint::slam
