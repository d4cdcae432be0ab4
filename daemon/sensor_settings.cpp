// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/sensor_settings.hpp"

#include <fmt/format.h>

#include <vector>

namespace glint::daemon {
namespace {

constexpr const char* kAuto = "auto";
constexpr const char* kAny = "any";

std::optional<std::string> unless_empty(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

/// What the user's own keys ask of the sensor.
WantedConfig user_settings(const Config::Sensor& sensor) {
  WantedConfig wanted;
  wanted.lidar_mode = unless_empty(sensor.lidar_mode);
  wanted.timestamp_mode = unless_empty(sensor.timestamp_mode);
  wanted.operating_mode = unless_empty(sensor.operating_mode);
  wanted.udp_profile_lidar = unless_empty(sensor.udp_profile_lidar);
  wanted.udp_profile_imu = unless_empty(sensor.udp_profile_imu);
  if (const auto& window = sensor.azimuth_window_mdeg; window.size() == 2) {
    wanted.azimuth_window_mdeg = {window[0], window[1]};
  }
  if (sensor.signal_multiplier > 0) wanted.signal_multiplier = sensor.signal_multiplier;
  return wanted;
}

/// Only what is sent to the address that is listened on arrives.
std::string listening_address(const Config::Sensor& sensor) {
  // The interface after an IPv6 group is this machine's own affair.
  const std::string& group = sensor.multicast_group;
  if (!group.empty()) return group.substr(0, group.find('%'));
  return sensor.bind_address.empty() ? "@auto" : sensor.bind_address;
}

WantedConfig all_settings(const Config::Sensor& sensor, UdpPorts ports) {
  WantedConfig wanted = user_settings(sensor);
  wanted.udp_port_lidar = ports.lidar;
  wanted.udp_port_imu = ports.imu;
  wanted.udp_dest =
      unless_empty(sensor.udp_dest == kAuto ? listening_address(sensor) : sensor.udp_dest);
  return wanted;
}

}  // namespace

SensorLinkOptions sensor_link_options(const Config::Sensor& sensor, UdpPorts ports) {
  SensorLinkOptions options;
  try {
    options.address = parse_sensor_address(sensor.host);
    if (sensor.configure) {
      options.session.wanted = all_settings(sensor, ports);
      check(*options.session.wanted);
    }
  } catch (const InputError& error) {
    throw ConfigError(error.what());
  }
  options.session.host = options.address.host;
  options.session.persist = sensor.persist;
  options.ports = ports;
  options.filter_source = sensor.source_address.empty();
  return options;
}

std::string idle_settings(const Config::Sensor& sensor) {
  if (!sensor.host.empty() && sensor.configure) return {};
  std::vector<std::string> keys;
  const auto settings = to_sensor_json(user_settings(sensor), {});
  for (const auto& [key, value] : settings.items()) keys.push_back(key);
  if (keys.empty()) return {};
  return fmt::format("the sensor is not told its {}: {}", fmt::join(keys, ", "),
                     sensor.host.empty() ? "sensor.host is not set" : "sensor.configure is false");
}

std::string source_filter(const Config::Sensor& sensor) {
  return sensor.source_address == kAny ? "" : sensor.source_address;
}

}  // namespace glint::daemon
