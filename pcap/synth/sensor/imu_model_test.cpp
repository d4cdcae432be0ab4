// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor/imu_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pcap/synth/motion/route.hpp"

namespace glint::synth {
namespace {

constexpr ImuNoise kSilent{0, 0, 0, 0, 0, 0};
const Eigen::Vector3d kImuPosition_m(0.006, -0.012, 0.008);

Pose level_rest(double) { return {}; }

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(ImuModel, AtRestAndLevelItFeelsOneGUpwardsAndNoTurn) {
  ImuModel silent(level_rest, kImuPosition_m, 100.0, kSilent, 1);
  const auto reading = silent.measure(3.0);
  EXPECT_NEAR((reading.acceleration_mps2 - Eigen::Vector3d(0, 0, 9.80665)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(reading.angular_rate_radps.norm(), 0.0, 1e-12);

  const ImuNoise noise;
  ImuModel imu(level_rest, kImuPosition_m, 100.0, noise, 1);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < 100; ++i) mean += imu.measure(0.01 * i).acceleration_mps2 / 100.0;
  EXPECT_NEAR(mean.norm(), 9.80665, 4 * noise.accel_bias_mps2);
}

TEST(ImuModel, TiltedItFeelsGravityAlongItsOwnAxes) {
  const Pose nose_down{Eigen::Quaterniond(Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitY())),
                       Eigen::Vector3d::Zero()};
  ImuModel imu([&](double) { return nose_down; }, kImuPosition_m, 100.0, kSilent, 1);
  EXPECT_NEAR((imu.measure(1.0).acceleration_mps2 - Eigen::Vector3d(-9.80665, 0, 0)).norm(), 0.0,
              1e-9);
}

TEST(ImuModel, LeverArmFeelsTheCentrifugalAcceleration) {
  const auto spinning = [](double t_s) {
    return Pose{so3_exp(2.0 * t_s * Eigen::Vector3d::UnitZ()), {1000.0, 2000.0, 0.0}};
  };
  ImuModel imu(spinning, {0.5, 0.0, 0.0}, 100.0, kSilent, 1);
  const auto reading = imu.measure(1.0);
  EXPECT_NEAR((reading.acceleration_mps2 - Eigen::Vector3d(-2.0, 0, 9.80665)).norm(), 0.0, 1e-4);
  EXPECT_NEAR((reading.angular_rate_radps - Eigen::Vector3d(0, 0, 2)).norm(), 0.0, 1e-9);
}

TEST(ImuModel, DifferentiationIsFarFinerThanTheNoise) {
  // As hard as motions get: gait and vibration, kilometres from the origin.
  const double rate = 2.0 * M_PI * 14.0;
  const auto shaking = [=](double t_s) {
    return Pose{so3_exp({0, 4e-4 * std::sin(rate * t_s), 0}),
                {3000.0, -4000.0, 1e-4 * std::sin(rate * t_s) + 0.02 * std::sin(12.0 * t_s)}};
  };
  const ImuModel imu(shaking, Eigen::Vector3d::Zero(), 100.0, kSilent, 1);
  for (double t_s = 1.0; t_s < 2.0; t_s += 0.0073) {
    const double up_mps2 = -1e-4 * rate * rate * std::sin(rate * t_s) -
                           0.02 * 144.0 * std::sin(12.0 * t_s) + kGravity_mps2;
    const double pitch_rad = 4e-4 * std::sin(rate * t_s);
    const Eigen::Vector3d felt(-std::sin(pitch_rad) * up_mps2, 0, std::cos(pitch_rad) * up_mps2);
    EXPECT_LT((imu.truth(t_s).acceleration_mps2 - felt).norm(), 1e-4) << t_s;
    EXPECT_NEAR(imu.truth(t_s).angular_rate_radps.y(), 4e-4 * rate * std::cos(rate * t_s), 1e-6);
  }
}

TEST(ImuModel, NoiseIsAsDenseAsToldAtEveryRate) {
  const ImuNoise noise{.accel_bias_mps2 = 0,
                       .gyro_bias_radps = 0,
                       .accel_walk_mps2_rts = 0,
                       .gyro_walk_radps_rts = 0};
  for (const double rate_hz : {100.0, 640.0}) {
    ImuModel imu(level_rest, kImuPosition_m, rate_hz, noise, 2);
    std::vector<double> accel;
    std::vector<double> gyro;
    std::vector<double> averaged;  // Over a second: the deviation is the density itself.
    for (int second = 0; second < 60; ++second) {
      double sum = 0.0;
      for (int i = 0; i < static_cast<int>(rate_hz); ++i) {
        const auto reading = imu.measure(0.0);
        accel.push_back(reading.acceleration_mps2.x());
        gyro.push_back(reading.angular_rate_radps.z());
        sum += gyro.back();
      }
      averaged.push_back(sum / rate_hz);
    }
    EXPECT_NEAR(root_mean_square(accel) / std::sqrt(rate_hz) / noise.accel_density_mps2_rthz, 1.0,
                0.05);
    EXPECT_NEAR(root_mean_square(gyro) / std::sqrt(rate_hz) / noise.gyro_density_radps_rthz, 1.0,
                0.05);
    EXPECT_NEAR(root_mean_square(averaged) / noise.gyro_density_radps_rthz, 1.0, 0.35) << "white";
  }
}

TEST(ImuModel, BiasIsDrawnAndWalksAsTold) {
  const ImuNoise noise;
  std::vector<double> at_first;
  std::vector<double> accel_walked;
  std::vector<double> gyro_walked;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    ImuModel imu(level_rest, kImuPosition_m, 100.0, noise, seed);
    const Eigen::Vector3d accel = imu.accel_bias_mps2();
    const Eigen::Vector3d gyro = imu.gyro_bias_radps();
    for (int i = 0; i < 400; ++i) imu.measure(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      at_first.push_back(accel[axis]);
      accel_walked.push_back(imu.accel_bias_mps2()[axis] - accel[axis]);
      gyro_walked.push_back(imu.gyro_bias_radps()[axis] - gyro[axis]);
    }
  }
  EXPECT_NEAR(root_mean_square(at_first) / noise.accel_bias_mps2, 1.0, 0.15);
  // Four seconds: twice the walk of one.
  EXPECT_NEAR(root_mean_square(accel_walked) / (2.0 * noise.accel_walk_mps2_rts), 1.0, 0.15);
  EXPECT_NEAR(root_mean_square(gyro_walked) / (2.0 * noise.gyro_walk_radps_rts), 1.0, 0.15);
}

TEST(ImuModel, SamplesFollowFromTheSeed) {
  ImuModel a(level_rest, kImuPosition_m, 100.0, {}, 5);
  ImuModel b(level_rest, kImuPosition_m, 100.0, {}, 5);
  ImuModel c(level_rest, kImuPosition_m, 100.0, {}, 6);
  const auto sample = a.measure(1.0);
  EXPECT_EQ(sample.acceleration_mps2, b.measure(1.0).acceleration_mps2);
  EXPECT_NE(sample.acceleration_mps2, c.measure(1.0).acceleration_mps2);
}

// What one knows after integrating, and by how much it is off.
struct Drift {
  double position_m = 0.0;
  double rotation_rad = 0.0;
};

// Integrates readings (trapezoids; each step turns by the mean rate) of an IMU that starts from
// rest, less the biases it has been switched on with.
Drift integrate(const Motion& motion, ImuModel imu, double rate_hz, double seconds) {
  const double step_s = 1.0 / rate_hz;
  const Eigen::Vector3d accel_bias = imu.accel_bias_mps2();
  const Eigen::Vector3d gyro_bias = imu.gyro_bias_radps();
  const Eigen::Vector3d gravity_mps2(0, 0, -kGravity_mps2);
  const Pose start = motion(0.0);
  Eigen::Quaterniond rotation = start.rotation;
  Eigen::Vector3d position_m = start * kImuPosition_m;
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  auto last = imu.measure(0.0);
  const int steps = static_cast<int>(std::lround(seconds * rate_hz));
  for (int i = 1; i <= steps; ++i) {
    const auto now = imu.measure(i * step_s);
    const Eigen::Vector3d felt = rotation * (last.acceleration_mps2 - accel_bias);
    const Eigen::Vector3d rate = 0.5 * (last.angular_rate_radps + now.angular_rate_radps);
    rotation = (rotation * so3_exp((rate - gyro_bias) * step_s)).normalized();
    const Eigen::Vector3d felt_next = rotation * (now.acceleration_mps2 - accel_bias);
    const Eigen::Vector3d acceleration = 0.5 * (felt + felt_next) + gravity_mps2;
    position_m += velocity_mps * step_s + 0.5 * acceleration * step_s * step_s;
    velocity_mps += acceleration * step_s;
    last = now;
  }
  const Pose end = motion(seconds);
  return {(position_m - end * kImuPosition_m).norm(), rotation.angularDistance(end.rotation)};
}

// The deviation that the noise leads to after a time, per axis. Each term is white noise or a walk
// integrated once or more; gravity turns an error of attitude into one of acceleration.
Drift expected_drift(const ImuNoise& noise, double seconds) {
  const auto root = [&](int power, double over) {
    return std::sqrt(std::pow(seconds, power) / over);
  };
  const double rotation_rad = std::hypot(noise.gyro_density_radps_rthz * root(1, 1),
                                         noise.gyro_walk_radps_rts * root(3, 3));
  const double by_gravity_m =
      kGravity_mps2 * std::hypot(noise.gyro_density_radps_rthz * root(5, 20),
                                 noise.gyro_walk_radps_rts * root(7, 252));
  const double by_accel_m = std::hypot(noise.accel_density_mps2_rthz * root(3, 3),
                                       noise.accel_walk_mps2_rts * root(5, 20));
  return {std::hypot(by_gravity_m, by_accel_m), rotation_rad};
}

class IntegratedImu : public testing::TestWithParam<const char*> {
 protected:
  const Motion motion_ = make_motion({.points_m = {{0, 0, 0}, {60, 0, 0}, {60, 40, 1}, {0, 40, 0}},
                                      .closed = true,
                                      .corner_radius_m = 8.0},
                                     {.kind = GetParam()}, 3);
};

TEST_P(IntegratedImu, FollowsTheTruthUpToTheSchemeWithoutNoise) {
  const ImuModel at_100_hz(motion_, kImuPosition_m, 100.0, kSilent, 1);
  const ImuModel at_400_hz(motion_, kImuPosition_m, 400.0, kSilent, 1);
  const Drift coarse = integrate(motion_, at_100_hz, 100.0, 25.0);
  const Drift fine = integrate(motion_, at_400_hz, 400.0, 25.0);
  EXPECT_LT(coarse.position_m, 0.1);
  EXPECT_LT(coarse.rotation_rad, 1e-4);
  // A scheme of second order: a sixteenth of the error.
  EXPECT_LT(fine.position_m, coarse.position_m / 8.0 + 1e-3);
  EXPECT_LT(fine.rotation_rad, coarse.rotation_rad / 8.0 + 1e-6);
}

TEST_P(IntegratedImu, AgreesWithTheTruthWithinItsNoise) {
  const ImuNoise noise;
  constexpr double kSeconds = 25.0;
  const Drift deviation = expected_drift(noise, kSeconds);
  double position_square = 0.0;
  double rotation_square = 0.0;
  constexpr int kRuns = 12;
  for (int seed = 0; seed < kRuns; ++seed) {
    const ImuModel imu(motion_, kImuPosition_m, 100.0, noise, static_cast<std::uint64_t>(seed));
    const Drift drift = integrate(motion_, imu, 100.0, kSeconds);
    EXPECT_LT(drift.position_m, 4.0 * deviation.position_m) << seed;
    EXPECT_LT(drift.rotation_rad, 4.0 * deviation.rotation_rad) << seed;
    position_square += drift.position_m * drift.position_m / kRuns;
    rotation_square += drift.rotation_rad * drift.rotation_rad / kRuns;
  }
  // Three axes of rotation; gravity takes the position along two.
  EXPECT_NEAR(std::sqrt(rotation_square) / (std::sqrt(3.0) * deviation.rotation_rad), 1.0, 0.35);
  EXPECT_NEAR(std::sqrt(position_square) / (std::sqrt(2.0) * deviation.position_m), 1.0, 0.45);
}

INSTANTIATE_TEST_SUITE_P(Motions, IntegratedImu, testing::Values("walking", "handheld", "vehicle"),
                         [](const auto& i) { return std::string(i.param); });

}  // namespace
}  // namespace glint::synth
