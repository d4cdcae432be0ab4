// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>

#include "driver/core/pose.hpp"

namespace glint::slam {

/// How sure a motion is that an IMU foretold: the covariance of an error-state Kalman filter, whose
/// estimates themselves are its owner's. The errors are those of the scan's pose in the local map
/// (translation, rotation; right perturbation), of its velocity (scan's frame, m/s) and of gravity
/// with the accelerometer's bias in it (odometry frame, m/s^2). Thread-compatible.
class MotionFilter {
 public:
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  /// A foretold scan.
  struct Prediction {
    Matrix12 covariance = Matrix12::Identity();
    /// Of the pose: translation then rotation, 1/m^2 and 1/rad^2.
    [[nodiscard]] Matrix6 information() const;
  };
  /// What a pose that was found tells of the other errors.
  struct Correction {
    Eigen::Vector3d velocity_mps;  ///< To be added, scan's frame.
    Eigen::Vector3d gravity_mps2;  ///< To be added, odometry frame.
  };

  MotionFilter() { reset(); }

  /// A map begins with a scan, of which nothing else is known.
  void reset();
  /// The next scan lies at T_reference_current; gravity in the reference's frame, whose attitude is
  /// R_odom_reference; the gyroscope's turn is good to `turn_sigma_rad`.
  [[nodiscard]] Prediction predict(const Pose& T_reference_current, double span_s,
                                   const Eigen::Vector3d& gravity_mps2,
                                   const Eigen::Quaterniond& R_odom_reference,
                                   double turn_sigma_rad) const;
  /// Of a pose found `off` from the foretold one (right perturbation).
  [[nodiscard]] static Correction correction(const Prediction& predicted, const Twist& off);
  /// What is to be believed of an `off` that keypoints alone tell.
  [[nodiscard]] static Twist tempered(const Prediction& predicted, const Twist& off);
  /// The scan's pose was found: `posterior` is its covariance, prediction and all that was measured
  /// taken together, or of the measurement alone where the prediction took no part.
  void learn(const Prediction& predicted, const Twist& off, const Matrix6& posterior,
             bool prediction_took_part);

  /// Along these axes (a projection, scan's frame) position and velocity are so much less certain.
  void distrust(const Eigen::Matrix3d& axes, double variance_m2, double variance_m2ps2);

 private:
  void adapt(const Prediction& predicted, const Twist& off, const Matrix6& posterior);

  Matrix12 covariance_;
  double unforeseen_ = 1.0;  ///< How much more than usual the velocity walks, squared.
};

}  // namespace glint::slam
