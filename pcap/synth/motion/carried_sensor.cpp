// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/carried_sensor.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "pcap/synth/random.hpp"

namespace glint::synth {
namespace {

enum Stream : std::uint64_t {
  kSines = 0x6A17,
  kUnevenUp,
  kUnevenPitch,
  kUnevenRoll,
  kWander,
  kHeight,
  kLookYaw,
  kLookPitch,
  kLookRoll
};

// One looks one way for a while, then turns quickly to another.
constexpr double kLookYawInterval_s = 0.75;
constexpr int kLookYawHold = 3;
constexpr double kLookTiltInterval_s = 0.5;
constexpr double kUnevenInterval_s = 0.25;
constexpr double kWanderInterval_s = 3.0;
constexpr double kHeightInterval_s = 2.5;

Eigen::Quaterniond attitude(double yaw_rad, double pitch_rad, double roll_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
}

}  // namespace

double CarriedSensor::Sine::at(double t_s) const { return std::sin(rate_radps * t_s + phase_rad); }

CarriedSensor::CarriedSensor(const Carrier& carrier, double height_m, ControlTable travel,
                             std::uint64_t seed)
    : carrier_(carrier),
      height_m_(height_m),
      travel_(std::move(travel)),
      uneven_{{hash_keys({seed, kUnevenUp}), kUnevenInterval_s},
              {hash_keys({seed, kUnevenPitch}), kUnevenInterval_s},
              {hash_keys({seed, kUnevenRoll}), kUnevenInterval_s}},
      wander_(hash_keys({seed, kWander}), kWanderInterval_s),
      height_(hash_keys({seed, kHeight}), kHeightInterval_s),
      look_yaw_(hash_keys({seed, kLookYaw}), kLookYawInterval_s, kLookYawHold),
      look_pitch_(hash_keys({seed, kLookPitch}), kLookTiltInterval_s),
      look_roll_(hash_keys({seed, kLookRoll}), kLookTiltInterval_s) {
  Random random{seed, kSines};
  const auto sine = [&](double low_hz, double high_hz) {
    const double rate_radps = 2.0 * M_PI * random.uniform(low_hz, high_hz);
    return Sine{rate_radps, random.uniform(0.0, 2.0 * M_PI)};
  };
  step_ = sine(1.7, 2.1);
  vibration_ = {sine(9.0, 14.0), sine(9.0, 14.0), sine(9.0, 14.0)};
}

// Up and down once a step, side to side once every two.
void CarriedSensor::add_gait(double t_s, double pace, Offset& offset) const {
  const double size = carrier_.gait * pace;
  const double step = step_.rate_radps * t_s + step_.phase_rad;
  const double stride = 0.5 * step;
  offset.up_m += size * 0.022 * std::sin(step);
  offset.left_m += size * 0.025 * std::sin(stride);
  offset.roll_rad += size * 0.018 * std::sin(stride + 0.4);
  offset.pitch_rad += size * 0.014 * std::sin(step + 1.1);
  offset.yaw_rad += size * 0.030 * std::sin(stride + 2.0);
}

// What the ground, the air and motors do.
void CarriedSensor::add_unrest(double t_s, double pace, Offset& offset) const {
  const auto add = [&](double t, double size, const auto& shake, double& to) {
    to += pace * size * shake.at(t);
  };
  add(t_s, carrier_.uneven_m, uneven_.up, offset.up_m);
  add(t_s, carrier_.uneven_rad, uneven_.pitch, offset.pitch_rad);
  add(t_s, carrier_.uneven_rad, uneven_.roll, offset.roll_rad);
  add(t_s, carrier_.vibration_m, vibration_.up, offset.up_m);
  add(t_s, carrier_.vibration_rad, vibration_.pitch, offset.pitch_rad);
  add(t_s, carrier_.vibration_rad, vibration_.roll, offset.roll_rad);
}

// What whoever carries or steers it chooses to do.
void CarriedSensor::add_will(double t_s, double awake, Offset& offset) const {
  offset.left_m += awake * carrier_.wander_m * wander_.at(t_s);
  if (carrier_.flies > 0.0) offset.up_m += awake * carrier_.flies * height_m_ * height_.at(t_s);
  if (carrier_.look_yaw_rad == 0.0) return;
  offset.yaw_rad += awake * carrier_.look_yaw_rad * look_yaw_.at(t_s);
  offset.pitch_rad += awake * carrier_.look_tilt_rad * look_pitch_.at(t_s);
  offset.roll_rad += awake * carrier_.look_tilt_rad * look_roll_.at(t_s);
}

Pose CarriedSensor::at(double t_s) const {
  const Control travel = travel_.at(t_s);
  Offset offset;
  if (carrier_.gait > 0.0) add_gait(t_s, travel[kPace], offset);
  if (carrier_.uneven_rad > 0.0) add_unrest(t_s, travel[kPace], offset);
  add_will(t_s, travel[kAwake], offset);

  const double heading_rad = travel[kHeading];
  Pose pose;
  pose.rotation = attitude(heading_rad + offset.yaw_rad, travel[kPitch] + offset.pitch_rad,
                           travel[kRoll] + offset.roll_rad);
  pose.translation_m = {travel[kX] - offset.left_m * std::sin(heading_rad),
                        travel[kY] + offset.left_m * std::cos(heading_rad),
                        travel[kZ] + height_m_ + offset.up_m};
  return pose;
}

}  // namespace glint::synth
