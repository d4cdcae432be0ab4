// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "driver/core/pose.hpp"
#include "slam/joint_terms.hpp"

namespace glint::slam {

/// An axis along or about which a scan's surfaces do not tell where it is. Value type.
struct WeakAxis {
  bool rotation = false;                            ///< About it; else along it.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< Odometry frame, unit length.
  /// Nothing else tells either: the pose goes on along it as the motion did.
  bool critical = false;
};

/// At most six, without allocation.
class WeakAxes {
 public:
  void add(const WeakAxis& axis) {
    if (count_ < axes_.size()) axes_[count_++] = axis;
  }
  [[nodiscard]] const WeakAxis* begin() const { return axes_.data(); }
  [[nodiscard]] const WeakAxis* end() const { return axes_.data() + count_; }
  [[nodiscard]] WeakAxis* begin() { return axes_.data(); }
  [[nodiscard]] WeakAxis* end() { return axes_.data() + count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool any_critical() const;

 private:
  std::array<WeakAxis, 6> axes_;
  std::size_t count_ = 0;
};

/// The axes that plane terms say next to nothing of, seen from T_odom_scan. Only normals are
/// looked at: pairs of points would claim to fix every axis. `before`: those of the last scan,
/// which must be held clearly to be weak no more. Pure.
WeakAxes find_weak_axes(std::span<const PlaneTerm> planes, const Pose& T_odom_scan,
                        const WeakAxes& before);

/// Whether keypoints carry a weak axis: enough of them, all around, agree on where the scan is
/// along it. `points` at the solution T_odom_scan. Pure.
bool carried_by_points(const WeakAxis& axis, std::span<const PointTerm> points,
                       const Pose& T_odom_scan);

/// Takes out of a scan's normal equations (right perturbation) what they say of the axes: the
/// projection P for hessian P H P and gradient P g.
Eigen::Matrix<double, 6, 6> projection_without(const WeakAxes& axes, const Pose& T_odom_scan);

}  // namespace glint::slam
