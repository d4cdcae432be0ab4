// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/keyframe_points.hpp"

#include <algorithm>

namespace glint::slam {

std::vector<MapPoint> keyframe_points(const SensorInfo& info, const XyzLut& lut,
                                      const ScanImages& images, int column_step,
                                      const std::function<Pose(int column)>& T_end_column) {
  std::vector<MapPoint> points;
  const int columns = images.range_mm.cols;
  for (int m = 0; m < columns; m += std::max(1, column_step)) {
    const Pose pose = T_end_column(m);
    for (int row = 0; row < images.range_mm.rows; ++row) {
      const int shift = info.pixel_shift_by_row[static_cast<std::size_t>(row)];
      const int u = ((m + shift) % columns + columns) % columns;
      const std::uint32_t range_mm = images.range_mm(row, u);
      if (range_mm == 0) continue;
      const Eigen::Vector3f p = (pose * lut.point(row, m, range_mm)).cast<float>();
      points.push_back({p.x(), p.y(), p.z(), static_cast<float>(images.intensity_u8(row, u))});
    }
  }
  return points;
}

}  // namespace glint::slam
