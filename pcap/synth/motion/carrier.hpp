// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <span>
#include <string_view>

namespace glint::synth {

/// What carries a sensor, and how it moves itself while it travels. Angles follow the axes of a
/// frame with x forwards and z up: pitch is positive nose down, roll is positive left side up.
struct Carrier {
  std::string_view name;
  double speed_mps;         ///< Usual cruising speed,
  double indoor_speed_mps;  ///< and under a low ceiling.
  double acceleration_mps2;
  double lateral_mps2;
  double yaw_rate_radps;  ///< At most, in corners.
  double base_m;          ///< Length over which it levels out the ground.
  double height_m;        ///< Of the sensor over the ground.
  double flies = 0.0;     ///< By this share its height varies, and the free height limits it.

  double follows_slope = 0.0;       ///< Pitch by the slope of the way.
  double pitch_rad_per_mps2 = 0.0;  ///< By acceleration forwards.
  double roll_rad_per_mps2 = 0.0;   ///< By acceleration to the left.

  double gait = 0.0;           ///< Share of a walker's bob, sway and nod.
  double look_yaw_rad = 0.0;   ///< Looking about: to either side,
  double look_tilt_rad = 0.0;  ///< up, down and over the shoulder.
  double wander_m = 0.0;       ///< Sideways off the way.
  double uneven_m = 0.0;       ///< Movement by uneven ground or air: up and down,
  double uneven_rad = 0.0;     ///< pitch and roll.
  double vibration_m = 0.0;    ///< Of motors and wheels: up and down,
  double vibration_rad = 0.0;  ///< pitch and roll.
};

/// All carriers, by the names of motion_names().
std::span<const Carrier> carriers();

}  // namespace glint::synth
