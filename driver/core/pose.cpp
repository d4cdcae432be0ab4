// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/core/pose.hpp"

#include <cmath>

namespace glint {
namespace {

// Below this angle the series are exact to double precision.
constexpr double kSmallAngle_rad = 1e-5;

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  const double half_sinc =
      angle < kSmallAngle_rad ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = half_sinc * rotation_rad;
  return q.normalized();
}

Eigen::Vector3d so3_log(const Eigen::Quaterniond& rotation) {
  // The quaternion of the shorter way round.
  const double sign = rotation.w() < 0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * rotation.vec();
  const double n = v.norm();
  if (n < kSmallAngle_rad) return 2.0 * v;
  return 2.0 * std::atan2(n, sign * rotation.w()) / n * v;
}

Pose se3_exp(const Twist& twist) {
  const Eigen::Vector3d rotation_rad = twist.tail<3>();
  const double angle = rotation_rad.norm();
  const Eigen::Matrix3d w = skew(rotation_rad);
  double a = 0.5 - angle * angle / 24.0;         // (1 - cos) / angle^2
  double b = 1.0 / 6.0 - angle * angle / 120.0;  // (angle - sin) / angle^3
  if (angle >= kSmallAngle_rad) {
    a = (1.0 - std::cos(angle)) / (angle * angle);
    b = (angle - std::sin(angle)) / (angle * angle * angle);
  }
  const Eigen::Matrix3d v = Eigen::Matrix3d::Identity() + a * w + b * w * w;
  return {so3_exp(rotation_rad), v * twist.head<3>()};
}

Twist se3_log(const Pose& pose) {
  const Eigen::Vector3d rotation_rad = so3_log(pose.rotation);
  const double angle = rotation_rad.norm();
  const Eigen::Matrix3d w = skew(rotation_rad);
  double c = 1.0 / 12.0 + angle * angle / 720.0;
  if (angle >= kSmallAngle_rad) {
    c = 1.0 / (angle * angle) - (1.0 + std::cos(angle)) / (2.0 * angle * std::sin(angle));
  }
  // At half a turn sin vanishes; the limit of the expression above is 1/pi^2.
  if (M_PI - angle < 1e-9) c = 1.0 / (M_PI * M_PI);
  const Eigen::Matrix3d v_inverse = Eigen::Matrix3d::Identity() - 0.5 * w + c * w * w;
  Twist twist;
  twist.head<3>() = v_inverse * pose.translation_m;
  twist.tail<3>() = rotation_rad;
  return twist;
}

Eigen::Matrix<double, 6, 6> adjoint(const Pose& T_a_b) {
  const Eigen::Matrix3d r = T_a_b.rotation.toRotationMatrix();
  Eigen::Matrix<double, 6, 6> out = Eigen::Matrix<double, 6, 6>::Zero();
  out.topLeftCorner<3, 3>() = r;
  out.topRightCorner<3, 3>() = skew(T_a_b.translation_m) * r;
  out.bottomRightCorner<3, 3>() = r;
  return out;
}

Pose interpolate(const Pose& a, const Pose& b, double fraction) {
  return a * se3_exp(fraction * se3_log(a.inverse() * b));
}

}  // namespace glint
