// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/lidar_scan.hpp"

namespace glint {

LidarScan::LidarScan(const PacketFormat& format)
    : column_time(static_cast<std::size_t>(format.columns_per_frame)),
      column_status(static_cast<std::size_t>(format.columns_per_frame)) {
  const auto allocate = [&]<class T>(Image<T>& image, Channel channel) {
    if (format.has(channel)) image = Image<T>(format.pixels_per_column, format.columns_per_frame);
  };
  allocate(range_mm, Channel::kRange);
  allocate(signal, Channel::kSignal);
  allocate(reflectivity, Channel::kReflectivity);
  allocate(near_ir, Channel::kNearIr);
  allocate(range2_mm, Channel::kRange2);
  allocate(signal2, Channel::kSignal2);
  allocate(reflectivity2, Channel::kReflectivity2);
}

}  // namespace glint
