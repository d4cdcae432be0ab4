// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "driver/core/lidar_scan.hpp"
#include "driver/core/sensor_info.hpp"
#include "slam/config.hpp"

namespace glint::slam {

class ImageFilter;

/// The DESTAGGERED images of one scan that features are taken from. Value type.
struct ScanImages {
  Image<std::uint32_t> range_mm;     ///< 0 = no return or nearer than min_range_m.
  Image<std::uint16_t> intensity;    ///< Signal where the profile has it, else reflectivity; raw.
  Image<std::uint8_t> intensity_u8;  ///< Scaled by running 1 % and 99 % quantiles; 0 = no return.
  /// What features are taken from: the filtered intensity (see image_filter.hpp; no return: 128),
  /// or where that is off `intensity_u8`.
  Image<std::uint8_t> brightness;
  Image<std::uint16_t> near_ir;  ///< Raw; empty where the profile lacks it.
};

/// Makes ScanImages from scans. Keeps the running quantiles, so scans must come in order.
/// Thread-compatible; no allocation after the first scan.
class ImageFormer {
 public:
  ImageFormer(const SensorInfo& info, const SlamConfig& config);
  ~ImageFormer();
  /// Fills `images`, reusing its buffers.
  void form(const LidarScan& scan, ScanImages& images);

 private:
  void update_scale(const ScanImages& images);

  std::vector<int> shift_;
  std::uint32_t min_range_mm_;
  double low_ = -1.0;   ///< Running 1 % quantile of the intensity; negative before the first scan.
  double high_ = -1.0;  ///< Running 99 % quantile.
  std::vector<std::uint32_t> histogram_;
  std::vector<std::uint8_t> scaled_;     ///< 8-bit value of each raw intensity.
  std::unique_ptr<ImageFilter> filter_;  ///< Null where it is off.
};

}  // namespace glint::slam
