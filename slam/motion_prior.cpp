// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/motion_prior.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace glint::slam {
namespace {

// What robots do unforeseen, from gliding to a jolt.
constexpr double kLeastAcceleration_mps2 = 0.5;
constexpr double kLargestAcceleration_mps2 = 10.0;
constexpr double kLeastTurnAcceleration_radps2 = 0.5;
constexpr double kLargestTurnAcceleration_radps2 = 30.0;
constexpr double kUsualAcceleration = 3.0;
// How fast these follow, per scan; jolts raise them at once.
constexpr double kForgetting = 0.05;
// Not even a body at rest is foretold better.
constexpr double kFloor_m = 0.01;
constexpr double kFloor_rad = 0.002;
constexpr double kGyroFloor_rad = 3e-4;
// Innovations are a mixture: the tails are longer than their RMS says.
constexpr double kCaution = 2.0;
// An IMU loses so much of the velocity in a second; a scan's pose is good to so much.
constexpr double kVelocityWalk_mps = 0.15;
constexpr double kPose_m = 0.005;
// Where only keypoints tell: some belong to what moves with the sensor.
constexpr double kOpenPose_m = 0.02;
constexpr double kUnknownVelocity_mps = 2.0;
constexpr double kStandardGravity_mps2 = 9.80665;

double followed(double rms, double latest, double least, double largest) {
  const double squared = rms * rms;
  const double gain = latest > rms ? 4.0 * kForgetting : kForgetting;
  return std::clamp(std::sqrt(squared + gain * (latest * latest - squared)), least, largest);
}

double grown_variance(double variance, double span_s) {
  const double walked_mps = kVelocityWalk_mps * span_s;
  return variance + walked_mps * walked_mps;
}

// Of a Kalman filter: what the IMU foretold, and by how much farther it went.
double velocity_gain(double variance, double pose_m, double span_s) {
  const double grown = grown_variance(variance, span_s);
  const double seen_mps = std::sqrt(2.0) * pose_m / span_s;
  return grown / (grown + seen_mps * seen_mps);
}

double variance_left(double variance, double pose_m, double span_s) {
  return (1.0 - velocity_gain(variance, pose_m, span_s)) * grown_variance(variance, span_s);
}

}  // namespace

double PredictedMotion::largest_sigma_m() const {
  const Eigen::Matrix3d way = information.topLeftCorner<3, 3>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(way, Eigen::EigenvaluesOnly);
  return 1.0 / std::sqrt(eigen.eigenvalues()(0));
}

Eigen::Matrix<double, 6, 6> PredictedMotion::held_information() const {
  if (!by_accelerometer) return Eigen::Matrix<double, 6, 6>::Zero();
  return filtered.information();
}

void MotionPrior::stop() {
  filter_.reset();
  gravity_mps2_.setZero();
  velocity_.setZero();
  open_.setZero();
  velocity_variance_ = open_velocity_variance_ = kUnknownVelocity_mps * kUnknownVelocity_mps;
  acceleration_mps2_ = turn_acceleration_radps2_ = kUsualAcceleration;
}

void MotionPrior::open_along(const Eigen::Matrix3d& axes) {
  if (open_.isZero(0.0)) open_velocity_variance_ = velocity_variance_;
  open_ = axes;
}

void MotionPrior::level_by(const Eigen::Vector3d& force_mps2) {
  if (!accelerometer_ || !gravity_mps2_.isZero(0.0) || force_mps2.isZero(0.0)) return;
  gravity_mps2_ = -kStandardGravity_mps2 * force_mps2.normalized();
}

PredictedMotion MotionPrior::predict(SensorTime from, SensorTime to, double span_s,
                                     const Eigen::Quaterniond& R_odom_reference,
                                     const ImuTrack* imu) const {
  PredictedMotion predicted;
  const auto measured = imu != nullptr ? imu->between(from, to) : std::nullopt;
  double sigma_rad = kFloor_rad + kCaution * turn_acceleration_radps2_ * span_s * span_s;
  if (measured) {
    const MotionState before{velocity_, R_odom_reference.conjugate() * gravity_mps2_};
    const Eigen::Quaterniond back = measured->turn.conjugate();
    predicted.by_gyro = true;
    predicted.by_accelerometer = !gravity_mps2_.isZero(0.0);
    predicted.T_reference_current = carried_on(before, *measured, span_s);
    predicted.state.gravity_mps2 = back * before.gravity_mps2;
    // Without accelerometer the body velocity goes on.
    predicted.state.velocity = velocity_;
    if (predicted.by_accelerometer) {
      predicted.state.velocity.head<3>() =
          back * (velocity_.head<3>() + span_s * before.gravity_mps2 + measured->velocity_mps);
    }
    if (span_s > 0) predicted.state.velocity.tail<3>() = so3_log(measured->turn) / span_s;
    const double turn_sigma_rad = imu->turn_sigma_rad(span_s, so3_log(measured->turn).norm());
    sigma_rad = kGyroFloor_rad + turn_sigma_rad;
    if (predicted.by_accelerometer) {
      predicted.filtered = filter_.predict(predicted.T_reference_current, span_s,
                                           before.gravity_mps2, R_odom_reference, turn_sigma_rad);
    }
  } else {
    predicted.T_reference_current = se3_exp(velocity_ * span_s);
    predicted.state.velocity = velocity_;
  }
  const auto information_of = [&](double velocity_variance) {
    const double sigma_m = kFloor_m + kCaution * acceleration_mps2_ * span_s * span_s +
                           std::sqrt(predicted.by_accelerometer ? velocity_variance : 0.0) * span_s;
    return 1.0 / (sigma_m * sigma_m);
  };
  const double held = information_of(velocity_variance_);
  const Eigen::Matrix3d R_odom_current =
      (R_odom_reference * predicted.T_reference_current.rotation).toRotationMatrix();
  predicted.information.topLeftCorner<3, 3>() =
      held * Eigen::Matrix3d::Identity() + (information_of(open_velocity_variance_) - held) *
                                               R_odom_current.transpose() * open_ * R_odom_current;
  predicted.information.diagonal().tail<3>().setConstant(1.0 / (sigma_rad * sigma_rad));
  return predicted;
}

MotionState MotionPrior::state_after(const PredictedMotion& predicted,
                                     const Pose& T_reference_current,
                                     const Eigen::Quaterniond& R_odom_reference,
                                     double span_s) const {
  MotionState state = predicted.state;
  if (span_s <= 0.0) return state;
  if (!predicted.by_accelerometer) {
    state.velocity = se3_log(T_reference_current) / span_s;
    return state;
  }
  const Twist off = se3_log(predicted.T_reference_current.inverse() * T_reference_current);
  return corrected(predicted, MotionFilter::tempered(predicted.filtered, off), off,
                   R_odom_reference * T_reference_current.rotation, span_s);
}

// By what is believed of `off`, and by all of it along open axes: motions are found less surely
// there than they seem, and a filter of its own follows them.
MotionState MotionPrior::corrected(const PredictedMotion& predicted, const Twist& believed,
                                   const Twist& off, const Eigen::Quaterniond& R_odom_scan,
                                   double span_s) const {
  MotionState state = predicted.state;
  const Eigen::Matrix3d R_odom_current = R_odom_scan.toRotationMatrix();
  const Eigen::Vector3d held_mps =
      R_odom_current * MotionFilter::correction(predicted.filtered, believed).velocity_mps;
  const Eigen::Vector3d open_mps = velocity_gain(open_velocity_variance_, kOpenPose_m, span_s) /
                                   span_s * (R_odom_current * off.head<3>());
  state.velocity.head<3>() +=
      R_odom_current.transpose() * (held_mps + open_ * (open_mps - held_mps));
  return state;
}

MotionState MotionPrior::learn(const PredictedMotion& predicted, const Pose& T_reference_current,
                               const Eigen::Quaterniond& R_odom_reference, double span_s,
                               const FoundMotion& found) {
  MotionState state = state_after(predicted, T_reference_current, R_odom_reference, span_s);
  const Twist off = se3_log(predicted.T_reference_current.inverse() * T_reference_current);
  if (predicted.by_accelerometer && span_s > 0.0) {
    state = corrected(predicted, off, off, R_odom_reference * T_reference_current.rotation, span_s);
  }
  velocity_ = state.velocity;
  if (span_s <= 0.0) return state;
  const Eigen::Matrix3d held = Eigen::Matrix3d::Identity() - open_;
  const Eigen::Matrix3d R_odom_current =
      (R_odom_reference * T_reference_current.rotation).toRotationMatrix();
  Twist innovation = off;
  innovation.head<3>() = R_odom_current.transpose() * (held * (R_odom_current * off.head<3>()));
  follow_accelerations(predicted, innovation, span_s);
  if (!predicted.by_accelerometer) return state;
  velocity_variance_ = variance_left(velocity_variance_, kPose_m, span_s);
  open_velocity_variance_ = variance_left(open_velocity_variance_, kOpenPose_m, span_s);
  gravity_mps2_ += held * MotionFilter::correction(predicted.filtered, off).gravity_mps2;
  filter_.learn(predicted.filtered, innovation, found.covariance, found.prediction_took_part);
  if (!open_.isZero(0.0)) {
    filter_.distrust(R_odom_current.transpose() * open_ * R_odom_current, kOpenPose_m * kOpenPose_m,
                     open_velocity_variance_);
  }
  return state;
}

void MotionPrior::follow_accelerations(const PredictedMotion& predicted, const Twist& innovation,
                                       double span_s) {
  const double per_s2 = 1.0 / (std::sqrt(3.0) * span_s * span_s);
  acceleration_mps2_ = followed(acceleration_mps2_, innovation.head<3>().norm() * per_s2,
                                kLeastAcceleration_mps2, kLargestAcceleration_mps2);
  if (predicted.by_gyro) return;
  turn_acceleration_radps2_ =
      followed(turn_acceleration_radps2_, innovation.tail<3>().norm() * per_s2,
               kLeastTurnAcceleration_radps2, kLargestTurnAcceleration_radps2);
}

}  // namespace glint::slam
