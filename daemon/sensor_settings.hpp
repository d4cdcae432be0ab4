// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <string>

#include "daemon/config.hpp"
#include "driver/session/network_client.hpp"
#include "driver/session/sensor_session.hpp"

namespace glint::daemon {

/// Where this machine takes a live sensor's packets.
struct UdpPorts {
  std::uint16_t lidar = 7502;
  std::uint16_t imu = 7503;
};

/// What the session with a live sensor is to be.
struct SensorLinkOptions {
  SensorAddress address;
  SessionOptions session;
  ClientTimeouts timeouts;
  UdpPorts ports;
  bool take_metadata = true;  ///< false: a file goes before what the sensor says of itself.
  bool filter_source = true;  ///< Packets of other addresses than the sensor's are dropped.
};

/// The session that the configuration asks for; sensor.host must not be empty.
/// @throws ConfigError that names the key.
SensorLinkOptions sensor_link_options(const Config::Sensor& sensor, UdpPorts ports);

/// Why settings for the sensor have no effect, by name; empty when they have or there are none.
std::string idle_settings(const Config::Sensor& sensor);

/// sensor.source_address as a source takes it: "any" is empty.
std::string source_filter(const Config::Sensor& sensor);

}  // namespace glint::daemon
