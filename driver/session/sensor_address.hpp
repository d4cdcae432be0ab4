// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace glint {

/// Where a sensor listens. Value type.
struct SensorAddress {
  std::string host;  ///< Name or IP address, without brackets.
  std::uint16_t http_port = 80;
  std::uint16_t tcp_port = 7501;  ///< Of the text commands of old firmware.
};

/// Reads "os-122246000293.local", "10.0.0.7", "[fe80::1%eth0]", each also with ":PORT" of HTTP.
/// @throws InputError when it is none of these.
SensorAddress parse_sensor_address(std::string_view text);

}  // namespace glint
