// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/degeneracy.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace glint::slam {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// An axis is weak when the squared cosines between it and the normals (or the squared levers about
// it, as shares of the points' distances) add up to less than this, or than this share of the
// terms: noise alone turns normals by 0.02 rad, which makes 0.0005. One that was weak is so until
// they are half as many again.
constexpr double kSmallestHold = 2.0;
constexpr double kSmallestShare = 0.003;
constexpr double kHysteresis = 1.5;
// Two axes with a larger cosine between them are one that has turned a little.
constexpr double kSameAxis = 0.8;
// Keypoints carry an axis when so many of them, in so many of eight sectors, agree to this.
constexpr int kFewestCarriers = 15;
constexpr int kCarrierSectors = 8;
constexpr int kFewestSectors = 3;
constexpr double kAgreeing_m = 0.05;
// Points nearer to an axis than this share of their distance tell no turn about it.
constexpr double kLever = 0.2;

struct PlaneMoments {
  Eigen::Matrix3d translation = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
};

// Of the terms in the odometry frame, about the sensor: what is squared and summed over normals and
// levers, the latter as shares of the point's distance.
PlaneMoments moments(std::span<const PlaneTerm> planes, const Pose& T_odom_scan) {
  PlaneMoments sum;
  for (const PlaneTerm& term : planes) {
    sum.translation.noalias() += term.normal * term.normal.transpose();
    const Eigen::Vector3d arm = (T_odom_scan.rotation * term.point_m).normalized();
    const Eigen::Vector3d lever = arm.cross(term.normal);
    sum.rotation.noalias() += lever * lever.transpose();
  }
  return sum;
}

bool was_weak(const WeakAxes& before, const WeakAxis& axis) {
  return std::any_of(before.begin(), before.end(), [&](const WeakAxis& other) {
    return other.rotation == axis.rotation && std::abs(other.axis.dot(axis.axis)) > kSameAxis;
  });
}

}  // namespace

bool WeakAxes::any_critical() const {
  return std::any_of(begin(), end(), [](const WeakAxis& axis) { return axis.critical; });
}

WeakAxes find_weak_axes(std::span<const PlaneTerm> planes, const Pose& T_odom_scan,
                        const WeakAxes& before) {
  WeakAxes weak;
  const PlaneMoments sums = moments(planes, T_odom_scan);
  const double threshold =
      std::max(kSmallestHold, kSmallestShare * static_cast<double>(planes.size()));
  for (const bool rotation : {false, true}) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(rotation ? sums.rotation : sums.translation);
    for (int i = 0; i < 3; ++i) {
      const WeakAxis axis{rotation, eigen.eigenvectors().col(i).normalized(), false};
      const double limit = was_weak(before, axis) ? kHysteresis * threshold : threshold;
      if (eigen.eigenvalues()(i) >= limit) break;  // The next ones are held better.
      weak.add(axis);
    }
  }
  return weak;
}

bool carried_by_points(const WeakAxis& axis, std::span<const PointTerm> points,
                       const Pose& T_odom_scan) {
  int carriers = 0;
  unsigned sectors = 0;
  const Eigen::Vector3d* last = nullptr;
  for (const PointTerm& term : points) {
    // A keypoint that several scans saw stands several times in a row.
    if (last != nullptr && *last == term.point_m) continue;
    const Eigen::Vector3d error_m = T_odom_scan * term.point_m - term.fixed_m;
    const Eigen::Vector3d arm_m = T_odom_scan.rotation * term.point_m;
    if (axis.rotation) {
      const Eigen::Vector3d lever = axis.axis.cross(arm_m);
      if (lever.norm() < kLever * arm_m.norm()) continue;
      if (std::abs(error_m.dot(lever.normalized())) > kAgreeing_m) continue;
    } else if (std::abs(error_m.dot(axis.axis)) > kAgreeing_m) {
      continue;
    }
    last = &term.point_m;
    ++carriers;
    const double turn = std::atan2(term.point_m.y(), term.point_m.x()) / (2.0 * std::numbers::pi);
    sectors |= 1U << static_cast<unsigned>((turn + 1.0) * kCarrierSectors) % kCarrierSectors;
  }
  return carriers >= kFewestCarriers && std::popcount(sectors) >= kFewestSectors;
}

Matrix6 projection_without(const WeakAxes& axes, const Pose& T_odom_scan) {
  Matrix6 projection = Matrix6::Identity();
  for (const WeakAxis& axis : axes) {
    const Eigen::Vector3d v = T_odom_scan.rotation.conjugate() * axis.axis;
    const int at = axis.rotation ? 3 : 0;
    projection.block<3, 3>(at, at) -= v * v.transpose();
  }
  return projection;
}

}  // namespace glint::slam
