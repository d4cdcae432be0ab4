// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstdint>

#include "driver/core/pose.hpp"
#include "pcap/synth/motion/carrier.hpp"
#include "pcap/synth/motion/control_table.hpp"
#include "pcap/synth/motion/smooth_noise.hpp"

namespace glint::synth {

/// Where a sensor is that a carrier takes along: the carrier's travel and, on top, how it moves
/// itself, random by the seed. Immutable, thread-safe, and cheap to ask.
class CarriedSensor {
 public:
  /// `height_m`: of the sensor over the ground.
  CarriedSensor(const Carrier& carrier, double height_m, ControlTable travel, std::uint64_t seed);

  /// T_world_sensor.
  [[nodiscard]] Pose at(double t_s) const;

 private:
  /// What is added to the carrier's own place and attitude.
  struct Offset {
    double left_m = 0.0, up_m = 0.0;
    double yaw_rad = 0.0, pitch_rad = 0.0, roll_rad = 0.0;
  };
  void add_gait(double t_s, double pace, Offset& offset) const;
  void add_unrest(double t_s, double pace, Offset& offset) const;
  void add_will(double t_s, double awake, Offset& offset) const;

  struct Sine {
    double rate_radps, phase_rad;
    [[nodiscard]] double at(double t_s) const;
  };
  /// Up and down, pitch, roll.
  template <class T>
  struct Shake {
    T up, pitch, roll;
  };

  const Carrier& carrier_;  ///< Of the constant table.
  const double height_m_;
  const ControlTable travel_;
  Sine step_;
  Shake<Sine> vibration_;
  Shake<SmoothNoise> uneven_;
  SmoothNoise wander_, height_, look_yaw_, look_pitch_, look_roll_;
};

}  // namespace glint::synth
