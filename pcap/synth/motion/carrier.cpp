// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/carrier.hpp"

#include <array>

namespace glint::synth {
namespace {

constexpr double kRadPerDeg = 0.017453292519943295;
constexpr double kPerGravity = 1.0 / 9.80665;

constexpr std::array<Carrier, 5> kCarriers{{
    {.name = "wheeled",
     .speed_mps = 1.5,
     .indoor_speed_mps = 1.5,
     .acceleration_mps2 = 0.7,
     .lateral_mps2 = 1.0,
     .yaw_rate_radps = 1.0,
     .base_m = 0.5,
     .height_m = 0.6,
     .follows_slope = 1.0,
     .pitch_rad_per_mps2 = -0.003,
     .roll_rad_per_mps2 = 0.003,
     .wander_m = 0.04,
     .uneven_m = 0.0015,
     .uneven_rad = 0.3 * kRadPerDeg,
     .vibration_m = 1e-4,
     .vibration_rad = 4e-4},
    {.name = "walking",
     .speed_mps = 1.2,
     .indoor_speed_mps = 1.2,
     .acceleration_mps2 = 0.8,
     .lateral_mps2 = 1.2,
     .yaw_rate_radps = 1.2,
     .base_m = 0.6,
     .height_m = 1.25,
     .gait = 1.0,
     .wander_m = 0.08},
    {.name = "handheld",
     .speed_mps = 1.0,
     .indoor_speed_mps = 1.0,
     .acceleration_mps2 = 0.7,
     .lateral_mps2 = 1.0,
     .yaw_rate_radps = 0.6,
     .base_m = 0.6,
     .height_m = 1.4,
     .gait = 0.8,
     .look_yaw_rad = 70.0 * kRadPerDeg,
     .look_tilt_rad = 10.0 * kRadPerDeg,
     .wander_m = 0.1},
    // Its thrust accelerates it, so it leans into whatever it does.
    {.name = "drone",
     .speed_mps = 3.0,
     .indoor_speed_mps = 1.5,
     .acceleration_mps2 = 1.5,
     .lateral_mps2 = 2.0,
     .yaw_rate_radps = 1.0,
     .base_m = 3.0,
     .height_m = 2.5,
     .flies = 0.2,
     .pitch_rad_per_mps2 = kPerGravity,
     .roll_rad_per_mps2 = -kPerGravity,
     .wander_m = 0.15,
     .uneven_rad = 0.8 * kRadPerDeg,
     .vibration_m = 1e-4,
     .vibration_rad = 4e-4},
    // Squats on its springs and leans out of curves.
    {.name = "vehicle",
     .speed_mps = 15.0,
     .indoor_speed_mps = 5.0,
     .acceleration_mps2 = 2.0,
     .lateral_mps2 = 2.5,
     .yaw_rate_radps = 0.6,
     .base_m = 2.7,
     .height_m = 1.9,
     .follows_slope = 1.0,
     .pitch_rad_per_mps2 = -0.006,
     .roll_rad_per_mps2 = 0.008,
     .wander_m = 0.1,
     .uneven_m = 0.015,
     .uneven_rad = 0.5 * kRadPerDeg,
     .vibration_m = 1e-4,
     .vibration_rad = 2e-4},
}};

}  // namespace

std::span<const Carrier> carriers() { return kCarriers; }

}  // namespace glint::synth
