// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/motion/motion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "pcap/synth/motion/carried_sensor.hpp"
#include "pcap/synth/motion/carrier.hpp"
#include "pcap/synth/motion/control_table.hpp"
#include "pcap/synth/motion/route.hpp"
#include "pcap/synth/motion/timetable.hpp"
#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

// Between two control points; smooths over about twice as much.
constexpr double kInterval_s = 0.15;
// The control points that act on the last moment of a rest, and what is derived from their
// neighbours, must be at rest.
constexpr double kLeadIntervals = 4.0;
constexpr double kWakeUp_s = 1.5;
constexpr double kMaxPace = 1.5;

constexpr double kIndoorHeight_m = 4.0;
constexpr double kLeastSpeed_mps = 0.05;
constexpr double kMaxSpeed_mps = 40.0;
constexpr double kMaxRest_s = 3600.0;
// What flies keeps below this share of the free height.
constexpr double kHighestShare = 0.6;

const Carrier& find_carrier(const std::string& name) {
  for (const Carrier& carrier : carriers()) {
    if (carrier.name == name) return carrier;
  }
  throw OptionError(
      fmt::format("unknown motion '{}': choose one of {}", name, fmt::join(motion_names(), ", ")));
}

void check(const MotionOptions& options) {
  const double speed_mps = options.speed_mps;
  if (speed_mps != 0.0 && !(speed_mps >= kLeastSpeed_mps && speed_mps <= kMaxSpeed_mps)) {
    throw OptionError(
        fmt::format("a speed of {} m/s is not possible: choose {} to {}, or 0 for what is usual",
                    speed_mps, kLeastSpeed_mps, kMaxSpeed_mps));
  }
  if (!(options.rest_s >= 0.0 && options.rest_s <= kMaxRest_s)) {
    throw OptionError(
        fmt::format("a rest of {} s is not possible: choose 0 to {}", options.rest_s, kMaxRest_s));
  }
}

double sensor_height_m(const Carrier& carrier, const Route& route) {
  if (carrier.flies == 0.0) return carrier.height_m;
  return std::min(carrier.height_m, kHighestShare * route.clear_height_m / (1.0 + carrier.flies));
}

// The carrier at a time since its start, with the accelerations between a little before and after
// turned into attitude.
Control control_at(const Timetable& timetable, const Carrier& carrier, double t_s,
                   double interval_s) {
  const Timetable::State now = timetable.at(t_s);
  const Timetable::State before = timetable.at(t_s - interval_s);
  const Timetable::State after = timetable.at(t_s + interval_s);
  const double forwards_mps2 = (after.speed_mps - before.speed_mps) / (2.0 * interval_s);
  const double left_mps2 =
      now.speed_mps * (after.point.heading_rad - before.point.heading_rad) / (2.0 * interval_s);
  Control control;
  control.head<3>() = now.point.position_m;
  control[kHeading] = now.point.heading_rad;
  control[kPitch] = carrier.pitch_rad_per_mps2 * forwards_mps2 -
                    carrier.follows_slope * std::asin(std::clamp(now.point.slope, -1.0, 1.0));
  control[kRoll] = carrier.roll_rad_per_mps2 * left_mps2;
  control[kPace] = std::min(now.speed_mps / carrier.speed_mps, kMaxPace);
  control[kAwake] = std::clamp(t_s / kWakeUp_s, 0.0, 1.0);
  return control;
}

// The rest, the first round from a standstill, and one round more that then repeats.
ControlTable tabulate(const Timetable& timetable, const Carrier& carrier, double rest_s) {
  const double rounds = std::ceil(timetable.round_s() / kInterval_s);
  const double interval_s = timetable.round_s() / rounds;
  const double start_s = rest_s + kLeadIntervals * interval_s;
  const double settled_s = std::max(timetable.first_round_s(), kWakeUp_s) + interval_s;
  const auto repeat_from = static_cast<std::size_t>(std::ceil((start_s + settled_s) / interval_s));
  const std::size_t count = repeat_from + static_cast<std::size_t>(rounds);
  std::vector<Control> controls;
  controls.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double t_s = static_cast<double>(k) * interval_s - start_s;
    controls.push_back(control_at(timetable, carrier, t_s, interval_s));
  }
  return {std::move(controls), repeat_from, interval_s, timetable.way().turn_rad()};
}

}  // namespace

std::span<const std::string_view> motion_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Carrier& carrier : carriers()) all.push_back(carrier.name);
    return all;
  }();
  return names;
}

Motion make_motion(const Route& route, const MotionOptions& options, std::uint64_t seed) {
  const Carrier& carrier = find_carrier(options.kind);
  check(options);
  const bool indoors = route.clear_height_m < kIndoorHeight_m;
  const double usual_mps = indoors ? carrier.indoor_speed_mps : carrier.speed_mps;
  const MotionLimits limits{.speed_mps = options.speed_mps > 0.0 ? options.speed_mps : usual_mps,
                            .acceleration_mps2 = carrier.acceleration_mps2,
                            .lateral_mps2 = carrier.lateral_mps2,
                            .yaw_rate_radps = carrier.yaw_rate_radps,
                            .smoothing_s = 2.0 * kInterval_s};
  const Timetable timetable(Way(route, carrier.base_m), limits);
  const auto sensor = std::make_shared<const CarriedSensor>(
      carrier, sensor_height_m(carrier, route), tabulate(timetable, carrier, options.rest_s), seed);
  return [sensor](double t_s) { return sensor->at(t_s); };
}

}  // namespace glint::synth
