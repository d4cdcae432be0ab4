// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "pcap/synth/motion/motion.hpp"
#include "pcap/synth/random.hpp"

namespace glint::synth {

/// How well the IMU measures; each axis for itself. Densities are those of data sheets: the
/// deviation of a sample is the density times the root of the sample rate.
struct ImuNoise {
  double accel_density_mps2_rthz = 0.0025;  ///< (m/s^2)/sqrt(Hz)
  double gyro_density_radps_rthz = 1.5e-4;  ///< (rad/s)/sqrt(Hz)
  double accel_bias_mps2 = 0.03;            ///< Deviation of the bias at switch-on.
  double gyro_bias_radps = 3e-3;            ///< Deviation of the bias at switch-on.
  double accel_walk_mps2_rts = 2e-4;        ///< Random walk of the bias, (m/s^2)/sqrt(s)
  double gyro_walk_radps_rts = 2e-5;        ///< Random walk of the bias, (rad/s)/sqrt(s)
};

constexpr double kGravity_mps2 = 9.80665;

/// What an IMU fixed to the sensor measures on a motion: specific force (at rest, level: +1 g along
/// z) and angular rate, both along the sensor's axes, with noise, bias and the bias's walk. Samples
/// are drawn one after the other. Thread-compatible.
class ImuModel {
 public:
  /// `position_m`: of the IMU in the sensor frame.
  ImuModel(Motion motion, const Eigen::Vector3d& position_m, double rate_hz, const ImuNoise& noise,
           std::uint64_t seed);

  struct Reading {
    Eigen::Vector3d acceleration_mps2;
    Eigen::Vector3d angular_rate_radps;
  };
  /// The next sample, taken `t_s` after the start.
  Reading measure(double t_s);
  /// Without noise and bias.
  [[nodiscard]] Reading truth(double t_s) const;
  [[nodiscard]] const Eigen::Vector3d& accel_bias_mps2() const { return accel_bias_mps2_; }
  [[nodiscard]] const Eigen::Vector3d& gyro_bias_radps() const { return gyro_bias_radps_; }

 private:
  const Motion motion_;
  const Eigen::Vector3d position_m_;
  const double rate_hz_;
  const ImuNoise noise_;
  Random random_;
  Eigen::Vector3d accel_bias_mps2_;
  Eigen::Vector3d gyro_bias_radps_;
};

}  // namespace glint::synth
