// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/sensor/imu_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace glint::synth {
namespace {

// Central differences of fourth order. Of a vibration of 0.1 mm and 0.4 mrad at 14 Hz they miss
// 1e-6 m/s^2 (h^4/90 of the sixth derivative) and 1e-7 rad/s (h^4/30 of the fifth). Doubles round a
// position kilometres away to 1e-12 m, which makes 1e-5 m/s^2.
constexpr double kStep_s = 1e-3;

Eigen::Vector3d gaussian_vector(Random& random, double deviation) {
  const double x = random.gaussian();
  const double y = random.gaussian();
  const double z = random.gaussian();
  return deviation * Eigen::Vector3d(x, y, z);
}

}  // namespace

ImuModel::ImuModel(Motion motion, const Eigen::Vector3d& position_m, double rate_hz,
                   const ImuNoise& noise, std::uint64_t seed)
    : motion_(std::move(motion)),
      position_m_(position_m),
      rate_hz_(rate_hz),
      noise_(noise),
      random_({seed, 0x1B0ULL}),
      accel_bias_mps2_(gaussian_vector(random_, noise.accel_bias_mps2)),
      gyro_bias_radps_(gaussian_vector(random_, noise.gyro_bias_radps)) {}

ImuModel::Reading ImuModel::truth(double t_s) const {
  // A trajectory may begin with a jolt at 0: what the IMU felt of it is before the first sample.
  const double middle_s = std::max(t_s, 2.0 * kStep_s);
  const Pose middle = motion_(middle_s);
  const Eigen::Vector3d here_m = middle * position_m_;
  // Displacement and rotation (about the sensor's own axes) from the middle to -2, -1, 1, 2 steps.
  std::array<Eigen::Vector3d, 4> moved_m;
  std::array<Eigen::Vector3d, 4> turned_rad;
  constexpr std::array kSteps{-2.0, -1.0, 1.0, 2.0};
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    const Pose pose = motion_(middle_s + kSteps[i] * kStep_s);
    moved_m[i] = pose * position_m_ - here_m;
    turned_rad[i] = so3_log(middle.rotation.conjugate() * pose.rotation);
  }
  const Eigen::Vector3d acceleration_mps2 =
      (16.0 * (moved_m[1] + moved_m[2]) - (moved_m[0] + moved_m[3])) / (12.0 * kStep_s * kStep_s);
  const Eigen::Vector3d up_mps2 = kGravity_mps2 * Eigen::Vector3d::UnitZ();
  return {
      middle.rotation.conjugate() * (acceleration_mps2 + up_mps2),
      (8.0 * (turned_rad[2] - turned_rad[1]) - (turned_rad[3] - turned_rad[0])) / (12.0 * kStep_s)};
}

ImuModel::Reading ImuModel::measure(double t_s) {
  Reading reading = truth(t_s);
  const double root_rate = std::sqrt(rate_hz_);
  reading.acceleration_mps2 +=
      accel_bias_mps2_ + gaussian_vector(random_, noise_.accel_density_mps2_rthz * root_rate);
  reading.angular_rate_radps +=
      gyro_bias_radps_ + gaussian_vector(random_, noise_.gyro_density_radps_rthz * root_rate);
  accel_bias_mps2_ += gaussian_vector(random_, noise_.accel_walk_mps2_rts / root_rate);
  gyro_bias_radps_ += gaussian_vector(random_, noise_.gyro_walk_radps_rts / root_rate);
  return reading;
}

}  // namespace glint::synth
