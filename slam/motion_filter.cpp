// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/motion_filter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

namespace glint::slam {
namespace {

// Of a map's first scan.
constexpr double kFirstPose_m = 0.001;
constexpr double kFirstPose_rad = 1e-4;
constexpr double kFirstVelocity_mps = 2.0;
constexpr double kFirstGravity_mps2 = 0.3;
// In a second the integrated accelerometer loses this much of the velocity, at least: noise, and
// what vibration and the clocks' disagreement make of it.
constexpr double kVelocityWalk_mps_rts = 0.01;
constexpr double kGravityWalk_mps2_rts = 0.005;
// Of a scan's way and turn, whatever the IMU measured: the instants of its columns.
constexpr double kWayFloor_m = 2e-4;
constexpr double kFilterTurnFloor_rad = 3e-5;
// What the registration of keypoints alone is good to.
constexpr double kKeypoints_m = 0.02;
constexpr double kKeypoints_rad = 0.005;
// How fast the velocity's walk follows what it shows to be.
constexpr double kFollowing = 0.05;
constexpr double kFastest = 4.0;
constexpr double kMostUnforeseen = 2500.0;

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

}  // namespace

MotionFilter::Matrix6 MotionFilter::Prediction::information() const {
  return covariance.topLeftCorner<6, 6>().inverse();
}

void MotionFilter::reset() {
  Eigen::Matrix<double, 12, 1> sigma;
  sigma << Eigen::Vector3d::Constant(kFirstPose_m), Eigen::Vector3d::Constant(kFirstPose_rad),
      Eigen::Vector3d::Constant(kFirstVelocity_mps), Eigen::Vector3d::Constant(kFirstGravity_mps2);
  covariance_ = sigma.cwiseAbs2().asDiagonal();
  unforeseen_ = 1.0;
}

MotionFilter::Prediction MotionFilter::predict(const Pose& T_reference_current, double span_s,
                                               const Eigen::Vector3d& gravity_mps2,
                                               const Eigen::Quaterniond& R_odom_reference,
                                               double turn_sigma_rad) const {
  const Eigen::Matrix3d back = T_reference_current.rotation.conjugate().toRotationMatrix();
  const Eigen::Matrix3d from_odom = back * R_odom_reference.conjugate().toRotationMatrix();
  // A tilted sensor feels its weight elsewhere.
  const Eigen::Matrix3d tilted = back * cross(gravity_mps2);
  const double half_square_s2 = 0.5 * span_s * span_s;
  Matrix12 carried = Matrix12::Zero();
  carried.topLeftCorner<6, 6>() = adjoint(T_reference_current.inverse());
  carried.block<3, 3>(0, 3) += half_square_s2 * tilted;
  carried.block<3, 3>(0, 6) = span_s * back;
  carried.block<3, 3>(0, 9) = half_square_s2 * from_odom;
  carried.block<3, 3>(6, 3) = span_s * tilted;
  carried.block<3, 3>(6, 6) = back;
  carried.block<3, 3>(6, 9) = span_s * from_odom;
  carried.block<3, 3>(9, 9).setIdentity();

  const double velocity_variance =
      unforeseen_ * kVelocityWalk_mps_rts * kVelocityWalk_mps_rts * span_s;
  Prediction predicted;
  predicted.covariance.noalias() = carried * covariance_ * carried.transpose();
  auto variances = predicted.covariance.diagonal();
  variances.segment<3>(0).array() +=
      kWayFloor_m * kWayFloor_m + velocity_variance * span_s * span_s / 3.0;
  variances.segment<3>(3).array() +=
      kFilterTurnFloor_rad * kFilterTurnFloor_rad + turn_sigma_rad * turn_sigma_rad;
  variances.segment<3>(6).array() += velocity_variance;
  variances.segment<3>(9).array() += kGravityWalk_mps2_rts * kGravityWalk_mps2_rts * span_s;
  return predicted;
}

MotionFilter::Correction MotionFilter::correction(const Prediction& predicted, const Twist& off) {
  const Matrix6 pose = predicted.covariance.topLeftCorner<6, 6>();
  const Eigen::Matrix<double, 6, 1> told =
      predicted.covariance.bottomLeftCorner<6, 6>() * pose.ldlt().solve(off);
  return {told.head<3>(), told.tail<3>()};
}

Twist MotionFilter::tempered(const Prediction& predicted, const Twist& off) {
  const Matrix6 pose = predicted.covariance.topLeftCorner<6, 6>();
  Matrix6 both = pose;
  both.diagonal().head<3>().array() += kKeypoints_m * kKeypoints_m;
  both.diagonal().tail<3>().array() += kKeypoints_rad * kKeypoints_rad;
  return pose * both.ldlt().solve(off);
}

// The rest of the state was measured only through the pose: given that, it is as foretold.
void MotionFilter::learn(const Prediction& predicted, const Twist& off, const Matrix6& posterior,
                         bool prediction_took_part) {
  const Matrix6 pose = predicted.covariance.topLeftCorner<6, 6>();
  Matrix6 left = posterior;
  if (!prediction_took_part) left = (pose.inverse() + posterior.inverse()).inverse();
  if (!left.allFinite()) return;
  if (prediction_took_part) adapt(predicted, off, left);
  const Matrix6 gain = pose.ldlt().solve(predicted.covariance.topRightCorner<6, 6>()).transpose();
  covariance_.topLeftCorner<6, 6>() = prediction_took_part ? left : posterior;
  covariance_.bottomLeftCorner<6, 6>() = gain * left;
  if (!prediction_took_part) covariance_.bottomLeftCorner<6, 6>().setZero();
  covariance_.topRightCorner<6, 6>() = covariance_.bottomLeftCorner<6, 6>().transpose();
  covariance_.bottomRightCorner<6, 6>() =
      predicted.covariance.bottomRightCorner<6, 6>() - gain * (pose - left) * gain.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

void MotionFilter::distrust(const Eigen::Matrix3d& axes, double variance_m2,
                            double variance_m2ps2) {
  covariance_.block<3, 3>(0, 0) += variance_m2 * axes;
  covariance_.block<3, 3>(6, 6) += variance_m2ps2 * axes;
}

// Corrections of a filter that knows what it does not know are as large as what they took away from
// its variance; larger ones say that the motion had more in it than the IMU tells.
void MotionFilter::adapt(const Prediction& predicted, const Twist& off, const Matrix6& posterior) {
  const Eigen::Matrix3d expected = predicted.covariance.topLeftCorner<3, 3>() -
                                   posterior.topLeftCorner<3, 3>() +
                                   kWayFloor_m * kWayFloor_m * Eigen::Matrix3d::Identity();
  const double ratio = off.head<3>().dot(expected.ldlt().solve(off.head<3>())) / 3.0;
  if (!(ratio >= 0.0)) return;
  const double factor = std::min(1.0 + kFollowing * (ratio - 1.0), kFastest);
  unforeseen_ = std::clamp(factor * unforeseen_, 1.0, kMostUnforeseen);
}

}  // namespace glint::slam
