// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "slam/motion_prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glint::slam {
namespace {

constexpr std::int64_t kScan_ns = 100'000'000;
constexpr double kScan_s = 0.1;
const Eigen::Vector3d kGravity_mps2(0.0, 0.0, -9.80665);

/// By its own measurement, to 5 mm and 1 mrad.
const FoundMotion kFound{
    (Twist() << Eigen::Vector3d::Constant(25e-6), Eigen::Vector3d::Constant(1e-6))
        .finished()
        .asDiagonal(),
    false};

/// A walker: on at 1.2 m/s, up and down by 2 cm twice a second.
Eigen::Vector3d place_m(double t_s) {
  return {1.2 * t_s, 0.0, 0.02 * std::cos(4.0 * std::numbers::pi * t_s)};
}
Eigen::Vector3d acceleration_mps2(double t_s) {
  const double omega = 4.0 * std::numbers::pi;
  return {0.0, 0.0, -0.02 * omega * omega * std::cos(omega * t_s)};
}

class MotionPriorTest : public testing::Test {
 protected:
  // Goes through `scans` scans of which each place becomes known, and returns the RMS of how far
  // the last half was foretold wrongly.
  double walk(MotionPrior& prior, int scans, bool with_imu) {
    ImuTrack imu;
    double squares = 0.0;
    for (int scan = 0; scan < scans; ++scan) {
      for (int i = scan == 0 ? 0 : 1; i <= 10; ++i) {
        const std::int64_t t_ns = scan * kScan_ns + i * kScan_ns / 10;
        ImuSample sample;
        sample.accel_time = sample.gyro_time = {t_ns};
        sample.acceleration_mps2 =
            acceleration_mps2(static_cast<double>(t_ns) * kSecondsPerNs) - kGravity_mps2;
        imu.add(sample);
      }
      const SensorTime from{scan * kScan_ns};
      const double from_s = kScan_s * scan;
      predicted_ = prior.predict(from, from + kScan_ns, kScan_s, Eigen::Quaterniond::Identity(),
                                 with_imu ? &imu : nullptr);
      const Pose truth{Eigen::Quaterniond::Identity(), place_m(from_s + kScan_s) - place_m(from_s)};
      const double error_m =
          (predicted_.T_reference_current.translation_m - truth.translation_m).norm();
      if (scan >= scans / 2) squares += error_m * error_m;
      state_ = prior.learn(predicted_, truth, Eigen::Quaterniond::Identity(), kScan_s, kFound);
    }
    return std::sqrt(squares / (scans - scans / 2));
  }

  PredictedMotion predicted_;
  MotionState state_;
};

// Gathers way for two seconds while what is seen claims that the sensor stands; returns the
// velocity that is believed in the end, m/s (true: 2).
double gather_way(MotionPrior& prior, bool open) {
  ImuTrack imu;
  prior.level_by(-kGravity_mps2);
  Eigen::Matrix3d along = Eigen::Matrix3d::Zero();
  along(0, 0) = 1.0;
  double believed_mps = 0.0;
  for (int scan = -20; scan < 20; ++scan) {
    const double acceleration = scan < 0 ? 0.0 : 1.0;
    for (int i = 0; i < 10; ++i) {
      ImuSample sample;
      sample.accel_time = sample.gyro_time = {scan * kScan_ns + i * kScan_ns / 10};
      sample.acceleration_mps2 = Eigen::Vector3d(acceleration, 0.0, 0.0) - kGravity_mps2;
      imu.add(sample);
    }
    const SensorTime from{scan * kScan_ns};
    const auto level = Eigen::Quaterniond::Identity();
    const PredictedMotion predicted = prior.predict(from, from + kScan_ns, kScan_s, level, &imu);
    if (open) prior.open_along(along);
    believed_mps = prior.learn(predicted, {}, level, kScan_s, kFound).velocity.x();
  }
  return believed_mps;
}

TEST_F(MotionPriorTest, AlongOpenAxesTheAccelerometerIsBelievedLonger) {
  MotionPrior held(true);
  MotionPrior open(true);
  EXPECT_LT(gather_way(held, false), 0.8);
  EXPECT_GT(gather_way(open, true), 1.1);
}

TEST_F(MotionPriorTest, WithoutImuTheMotionGoesOn) {
  MotionPrior prior(true);
  const double error_m = walk(prior, 60, false);
  EXPECT_FALSE(predicted_.by_gyro);
  EXPECT_NEAR(state_.velocity.x(), 1.2, 1e-9);
  EXPECT_GT(error_m, 0.01) << "the walker's bob comes unforeseen";
  const double sigma_m = 1.0 / std::sqrt(predicted_.information(2, 2));
  EXPECT_GT(sigma_m, error_m / 2.0);
  EXPECT_LT(sigma_m, error_m * 5.0);
}

TEST_F(MotionPriorTest, AnAccelerometerForetellsChangesOfVelocity) {
  MotionPrior prior(true);
  prior.level_by(-kGravity_mps2);
  const double error_m = walk(prior, 60, true);
  EXPECT_TRUE(predicted_.by_accelerometer);
  EXPECT_LT(error_m, 0.002);
  EXPECT_NEAR(state_.velocity.x(), 1.2, 0.01);
  const double held_sigma_m = 1.0 / std::sqrt(predicted_.held_information()(2, 2));
  EXPECT_GT(held_sigma_m, error_m / 2.0);
  EXPECT_LT(held_sigma_m, 0.01) << "surer than what it is trusted along open axes";
}

TEST_F(MotionPriorTest, GravityThatWasTakenWronglyIsMended) {
  MotionPrior prior(true);
  // The robot was accelerated as it began: down seems to be 3 degrees off.
  prior.level_by(-(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()) * kGravity_mps2));
  EXPECT_LT(walk(prior, 200, true), 0.004);
}

TEST_F(MotionPriorTest, WithoutAccelerometerTurnsAloneAreTaken) {
  MotionPrior prior(false);
  prior.level_by(-kGravity_mps2);
  EXPECT_GT(walk(prior, 60, true), 0.01);
  EXPECT_TRUE(predicted_.by_gyro);
  EXPECT_FALSE(predicted_.by_accelerometer);
  EXPECT_TRUE(predicted_.held_information().isZero(0.0));
}

}  // namespace
}  // namespace glint::slam
