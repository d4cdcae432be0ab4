// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "driver/core/pose.hpp"

namespace glint::synth {

struct Route;

/// T_world_sensor at `t_s` seconds after the start; also before it and without end. Smooth:
/// position and orientation have continuous second derivatives. Thread-safe.
using Motion = std::function<Pose(double t_s)>;

struct MotionOptions {
  /// "wheeled", "walking", "handheld", "drone" or "vehicle".
  std::string kind = "walking";
  /// Cruising speed, m/s; 0: what is usual for the kind.
  double speed_mps = 0.0;
  /// Stands still for so long first, s.
  double rest_s = 1.0;
};

/// Names that make_motion() knows.
std::span<const std::string_view> motion_names();

/// A sensor that is carried along a route. Speed, height, gait, vibration, looking about follow
/// from the kind and the seed. @throws OptionError that names the option and what is possible.
Motion make_motion(const Route& route, const MotionOptions& options, std::uint64_t seed);

}  // namespace glint::synth
