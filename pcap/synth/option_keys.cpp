// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/synth/option_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "pcap/synth/option_error.hpp"

namespace glint::synth {
namespace {

using Options = SimulationOptions;

template <class Number>
Number number(std::string_view name, const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc() && stop == end && std::isfinite(static_cast<double>(value))) {
    return value;
  }
  throw OptionError(fmt::format("{} = \"{}\" is no {}", name, text,
                                std::is_integral_v<Number> ? "whole number in range" : "number"));
}

constexpr std::array kImuProfiles = {ImuProfile::kLegacy, ImuProfile::kAccel32Gyro32Nmea};

template <class Profiles>
auto profile_named(const Profiles& profiles, const std::string& text) {
  std::vector<std::string_view> names;
  for (const auto profile : profiles) {
    if (text == to_string(profile)) return profile;
    names.push_back(to_string(profile));
  }
  throw OptionError(
      fmt::format("unknown profile '{}': choose one of {}", text, fmt::join(names, ", ")));
}

// An option that is one number of the options.
#define GLINT_NUMBER(NAME, WHAT, TYPE, MEMBER)                                           \
  OptionKey {                                                                            \
    NAME, WHAT, false, [](const Options& o) { return fmt::format("{}", o.MEMBER); },     \
        [](Options& o, const std::string& text) { o.MEMBER = number<TYPE>(NAME, text); } \
  }

const std::array kKeys = {
    GLINT_NUMBER("seconds", "How long, s", double, seconds),
    GLINT_NUMBER("seed", "Layout, way, sensor and noise follow from it", std::uint64_t, seed),
    OptionKey{"profile", "What lidar packets hold: any profile that glint reads, e.g. LEGACY",
              false, [](const Options& o) { return std::string(to_string(o.sensor.profile)); },
              [](Options& o, const std::string& text) {
                o.sensor.profile = profile_named(lidar_profiles(), text);
              }},
    OptionKey{"imu-profile", "What IMU packets hold: LEGACY or ACCEL32_GYRO32_NMEA", false,
              [](const Options& o) { return std::string(to_string(o.sensor.imu_profile)); },
              [](Options& o, const std::string& text) {
                o.sensor.imu_profile = profile_named(kImuProfiles, text);
              }},
    OptionKey{"sensor", "Optics: os0, os1 or os2", false,
              [](const Options& o) { return o.sensor.optics; },
              [](Options& o, const std::string& text) { o.sensor.optics = text; }},
    GLINT_NUMBER("beams", "16, 32, 64 or 128", int, sensor.beams),
    GLINT_NUMBER("columns", "512, 1024 or 2048", int, sensor.columns),
    GLINT_NUMBER("rate", "Scans a second: 10 or 20", int, sensor.rate_hz),
    GLINT_NUMBER("frame-id", "Of the first scan, 0 to 65535", std::uint16_t, sensor.first_frame_id),
    OptionKey{"motion", "wheeled, walking, handheld, drone or vehicle; default: the world's", false,
              [](const Options& o) { return o.motion.kind; },
              [](Options& o, const std::string& text) { o.motion.kind = text; }},
    GLINT_NUMBER("speed", "Cruising speed, m/s; 0: the motion's", double, motion.speed_mps),
    GLINT_NUMBER("rest", "Time to stand still first, s", double, motion.rest_s),
    OptionKey{"trajectory", "TUM or KITTI file of T_world_sensor to follow instead", false,
              [](const Options& o) { return o.trajectory.string(); },
              [](Options& o, const std::string& text) { o.trajectory = text; }},
    OptionKey{"photograph", "Grey picture (binary PGM) to hang up where posters hang", true,
              [](const Options&) { return std::string(); },
              [](Options& o, const std::string& text) { o.photographs.push_back(load_pgm(text)); }},
    GLINT_NUMBER("range-noise", "Deviation of the range of a strong return, m", double,
                 noise.range_sigma_m),
    GLINT_NUMBER("traffic", "In the street: times as many moving cars and people", double, traffic),
    GLINT_NUMBER("loss", "Share of datagrams that the network loses, 0 to 1", double, network.loss),
    GLINT_NUMBER("duplicates", "Share of datagrams that arrive twice", double, network.duplicates),
    GLINT_NUMBER("reordering", "Share of datagrams that arrive one to three late", double,
                 network.reordering),
    GLINT_NUMBER("first-column", "The first scan lacks the columns before this one", int,
                 stream.first_column),
    GLINT_NUMBER("restart-at", "The sensor restarts after so many seconds; 0: never", double,
                 stream.restart_at_s),
    GLINT_NUMBER("restart-gap", "How long it is silent then, s", double, stream.restart_gap_s),
};
#undef GLINT_NUMBER

}  // namespace

std::span<const OptionKey> option_keys() { return kKeys; }

SimulationOptions parse_simulation(std::string_view text, SimulationOptions options) {
  options.world = text.substr(0, text.find(','));
  while (text.find(',') != std::string_view::npos) {
    text.remove_prefix(text.find(',') + 1);
    const std::string_view pair = text.substr(0, text.find(','));
    const std::string_view name = pair.substr(0, pair.find('='));
    const auto* const key = std::find_if(kKeys.begin(), kKeys.end(),
                                         [&](const OptionKey& k) { return k.name == name; });
    if (key == kKeys.end() || name.size() == pair.size()) {
      std::vector<std::string_view> names;
      names.reserve(kKeys.size());
      for (const OptionKey& k : kKeys) names.push_back(k.name);
      throw OptionError(fmt::format("'{}' is no name=value with one of the names {}", pair,
                                    fmt::join(names, ", ")));
    }
    key->set(options, std::string(pair.substr(name.size() + 1)));
  }
  return options;
}

}  // namespace glint::synth
