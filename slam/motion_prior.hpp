// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>

#include "driver/core/pose.hpp"
#include "driver/core/time.hpp"
#include "slam/imu_track.hpp"
#include "slam/motion_filter.hpp"
#include "slam/scan_motion.hpp"

namespace glint::slam {

/// Where the motion so far leads, and how sure that is. Value type.
struct PredictedMotion {
  Pose T_reference_current;
  /// Of T_reference_current: translation then rotation, right perturbation, 1/m^2 and 1/rad^2.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  MotionState state;                  ///< Then, current frame.
  bool by_gyro = false;               ///< The turn was measured.
  bool by_accelerometer = false;      ///< So was the change of velocity.
  MotionFilter::Prediction filtered;  ///< Only by_accelerometer.

  /// As sure as the motion is along the axes that surfaces hold, where `information` is for those
  /// that they leave open: what keypoints tell there is not good to what they show. Zero unless
  /// by_accelerometer.
  [[nodiscard]] Eigen::Matrix<double, 6, 6> held_information() const;

  /// Of the way, along the axis that is known least.
  [[nodiscard]] double largest_sigma_m() const;
};

/// How sure a motion is that was found.
struct FoundMotion {
  /// Translation then rotation, right perturbation, m^2 and rad^2.
  Eigen::Matrix<double, 6, 6> covariance;
  bool prediction_took_part = false;  ///< In the motion, and in its covariance.
};

/// Foretells the next scan's pose: as the IMU measured the motion where there is one, else at a
/// constant body velocity. With an accelerometer a MotionFilter keeps velocity and gravity (with
/// the accelerometer's bias in it) and tells how sure the pose is; without one, and along open
/// axes, how well it foretold so far tells that. Thread-compatible.
class MotionPrior {
 public:
  /// With the accelerometer too, or turns alone.
  explicit MotionPrior(bool accelerometer) : accelerometer_(accelerometer) { stop(); }

  /// The motion from `from` to `to`, `span_s` by what is known of the clock, of a sensor that is
  /// turned by R_odom_reference at `from`. `imu` may be null.
  [[nodiscard]] PredictedMotion predict(SensorTime from, SensorTime to, double span_s,
                                        const Eigen::Quaterniond& R_odom_reference,
                                        const ImuTrack* imu) const;
  /// How the sensor moves at the end of T_reference_current, which was found where `predicted` was
  /// foretold.
  [[nodiscard]] MotionState state_after(const PredictedMotion& predicted,
                                        const Pose& T_reference_current,
                                        const Eigen::Quaterniond& R_odom_reference,
                                        double span_s) const;
  /// The same, and it is what the next motion follows.
  MotionState learn(const PredictedMotion& predicted, const Pose& T_reference_current,
                    const Eigen::Quaterniond& R_odom_reference, double span_s,
                    const FoundMotion& found);
  /// From now on motions are found without surfaces along the axes that this projects onto
  /// (odometry frame): less is learned from them, and more slowly.
  void open_along(const Eigen::Matrix3d& axes);
  /// A sensor that is all but at rest measured this specific force, odometry frame: it tells where
  /// down is. Only the first one counts.
  void level_by(const Eigen::Vector3d& force_mps2);
  /// Gravity in the odometry frame is found to be this, m/s^2.
  void level_anew(const Eigen::Vector3d& gravity_mps2) { gravity_mps2_ = gravity_mps2; }
  /// Nothing is known: not where down is, and the velocity may be anything that a robot does.
  void stop();

 private:
  [[nodiscard]] MotionState corrected(const PredictedMotion& predicted, const Twist& believed,
                                      const Twist& off, const Eigen::Quaterniond& R_odom_scan,
                                      double span_s) const;
  void follow_accelerations(const PredictedMotion& predicted, const Twist& innovation,
                            double span_s);

  bool accelerometer_;
  MotionFilter filter_;
  Eigen::Vector3d gravity_mps2_ = Eigen::Vector3d::Zero();  ///< Odometry frame; zero: unknown.
  Twist velocity_ = Twist::Zero();                          ///< Frame of the last scan.
  Eigen::Matrix3d open_ = Eigen::Matrix3d::Zero();          ///< See open_along().
  double velocity_variance_;                                ///< An axis that surfaces hold.
  double open_velocity_variance_;                           ///< One that they leave open.
  double acceleration_mps2_;  ///< That was not foretold; RMS over the last seconds.
  double turn_acceleration_radps2_;
};

}  // namespace glint::slam
