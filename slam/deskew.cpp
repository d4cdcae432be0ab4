// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/deskew.hpp"

namespace glint::slam {

void deskew(const std::vector<Eigen::Vector3d>& points_m, const std::vector<SensorTime>& times,
            const ConstantVelocity& motion, std::vector<Eigen::Vector3d>& out_m) {
  out_m.resize(points_m.size());
  for (std::size_t i = 0; i < points_m.size(); ++i) out_m[i] = motion.at(times[i]) * points_m[i];
}

}  // namespace glint::slam
