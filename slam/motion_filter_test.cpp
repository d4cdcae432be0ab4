// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/motion_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace glint::slam {
namespace {

using Matrix6 = MotionFilter::Matrix6;

constexpr double kSpan_s = 0.1;
const Eigen::Vector3d kDown_mps2(0.0, 0.0, -9.80665);

Matrix6 diagonal(double sigma_m, double sigma_rad) {
  Twist variances;
  variances << Eigen::Vector3d::Constant(sigma_m * sigma_m),
      Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  return variances.asDiagonal();
}

MotionFilter::Prediction stand(const MotionFilter& filter) {
  return filter.predict(Pose{}, kSpan_s, kDown_mps2, Eigen::Quaterniond::Identity(), 1e-4);
}

// A sensor that stands, located to `sigma_m` and 0.3 mrad by each scan: what is foretold after
// `scans`. `offs`: how far each scan was found off.
struct Located {
  MotionFilter filter;
  MotionFilter::Prediction predicted;
};
Located locate(double sigma_m, int scans, const Twist& off = Twist::Zero()) {
  Located located;
  for (int i = 0; i < scans; ++i) {
    located.predicted = stand(located.filter);
    const Matrix6 posterior =
        (located.predicted.information() + diagonal(sigma_m, 3e-4).inverse()).inverse();
    located.filter.learn(located.predicted, off, posterior, true);
  }
  located.predicted = stand(located.filter);
  return located;
}

double sigma_m(const MotionFilter::Prediction& predicted) {
  return std::sqrt(predicted.covariance(0, 0));
}

// Before the velocity is known, metres; then less than a scan's own measurement.
TEST(MotionFilterTest, ScansTogetherForetellTheNextOneBetterThanOneIsMeasured) {
  EXPECT_GT(sigma_m(stand(MotionFilter())), 0.1);
  EXPECT_LT(sigma_m(locate(0.002, 30).predicted), 0.002);
  EXPECT_GT(sigma_m(locate(0.002, 30).predicted), 0.0002);
}

TEST(MotionFilterTest, APoseFurtherOnMeansThatTheSensorIsFaster) {
  const MotionFilter filter;
  Twist off = Twist::Zero();
  off.x() = 0.05;
  // Nothing is known of the velocity: all of it is.
  EXPECT_NEAR(MotionFilter::correction(stand(filter), off).velocity_mps.x(), 0.5, 0.01);
  const auto settled = locate(0.002, 30).predicted;
  EXPECT_LT(MotionFilter::correction(settled, off).velocity_mps.x(), 0.4);
  EXPECT_GT(MotionFilter::correction(settled, off).velocity_mps.x(), 0.05);
}

// Keypoints alone are not believed against what is known well.
TEST(MotionFilterTest, ARoughOffsetIsTempered) {
  Twist off = Twist::Zero();
  off.x() = 0.05;
  EXPECT_GT(MotionFilter::tempered(stand(MotionFilter()), off).x(), 0.049);
  EXPECT_LT(MotionFilter::tempered(locate(0.002, 30).predicted, off).x(), 0.002);
}

TEST(MotionFilterTest, UnforeseenMotionMakesItLessSure) {
  Twist off = Twist::Zero();
  off.x() = 0.03;
  EXPECT_GT(sigma_m(locate(0.002, 60, off).predicted), 2.0 * sigma_m(locate(0.002, 60).predicted));
}

// An error of the pitch makes a part of the weight look like forward acceleration.
TEST(MotionFilterTest, AnErrorOfTheAttitudeBecomesOneOfTheVelocity) {
  const auto predicted = stand(MotionFilter());
  // By the weight over the span, less what the last turn added to the attitude alone.
  const double share_mps = predicted.covariance(6, 4) / predicted.covariance(4, 4);
  EXPECT_GT(share_mps, 0.0);
  EXPECT_LE(share_mps, kSpan_s * 9.80665);
  EXPECT_NEAR(predicted.covariance(7, 3), -predicted.covariance(6, 4), 1e-15);
  EXPECT_NEAR(predicted.covariance(8, 5), 0.0, 1e-15) << "a turn about the weight changes nothing";
}

TEST(MotionFilterTest, WhatIsDistrustedIsLessSureAlongThatAxisAlone) {
  MotionFilter filter = locate(0.002, 30).filter;
  const auto before = stand(filter);
  filter.distrust(Eigen::Vector3d::UnitX() * Eigen::RowVector3d::UnitX(), 4e-4, 1e-2);
  const auto after = stand(filter);
  EXPECT_GT(after.covariance(0, 0), before.covariance(0, 0) + 4e-4);
  EXPECT_DOUBLE_EQ(after.covariance(1, 1), before.covariance(1, 1));
}

// Positions of a walk in one dimension, found with noise where truth and accelerations are known:
// the errors are as large as the filter says.
TEST(MotionFilterTest, ItsCovarianceIsThatOfItsErrors) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  constexpr double kMeasured_m = 0.003;
  MotionFilter filter;
  double error_m = 0.0;  // Estimate less truth.
  double error_mps = 0.3;
  double squares = 0.0;
  int count = 0;
  for (int i = 0; i < 3000; ++i) {
    error_m += kSpan_s * error_mps;
    const auto predicted = stand(filter);
    const Matrix6 measured = diagonal(kMeasured_m, 3e-4);
    const Matrix6 posterior = (predicted.information() + measured.inverse()).inverse();
    Twist measurement = Twist::Zero();  // Of the error that is to be taken off.
    measurement.x() = -error_m + kMeasured_m * normal(random);
    const Twist off = posterior * measured.inverse() * measurement;
    error_mps += MotionFilter::correction(predicted, off).velocity_mps.x();
    error_m += off.x();
    // The accelerometer's noise.
    error_mps += 0.01 * std::sqrt(kSpan_s) * normal(random);
    filter.learn(predicted, off, posterior, true);
    if (i < 100) continue;
    squares += error_m * error_m / posterior(0, 0);
    ++count;
  }
  EXPECT_GT(squares / count, 0.5);
  EXPECT_LT(squares / count, 2.0);
}

}  // namespace
}  // namespace glint::slam
