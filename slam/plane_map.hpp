// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "driver/core/pose.hpp"
#include "slam/joint_terms.hpp"

namespace glint::slam {

/// The surfaces around the sensor that its scans are held against, in the odometry frame; ground
/// apart from all others. Thread-compatible.
class PlaneMap {
 public:
  PlaneMap() = default;
  PlaneMap(const PlaneMap&) = delete;
  PlaneMap& operator=(const PlaneMap&) = delete;
  virtual ~PlaneMap() = default;

  /// The plane terms of a scan seen from about T_odom_scan; the first `ground_count` points (scan
  /// frame) are on the ground. Points without a plane near them give none.
  virtual void associate(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                         const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) = 0;
  /// The same for the points that associate() last had, from a pose somewhat off that one; not
  /// after add().
  virtual void associate_again(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                               const Pose& T_odom_scan, std::vector<PlaneTerm>& terms) = 0;
  /// Adds a scan's points, and lets go what is not needed any more.
  virtual void add(std::span<const Eigen::Vector3f> points_m, std::size_t ground_count,
                   const Pose& T_odom_scan) = 0;
  virtual void clear() = 0;
  /// Points or planes, whatever it is made of.
  [[nodiscard]] virtual std::size_t size() const = 0;
};

}  // namespace glint::slam
