// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/doctor/facts.hpp"

namespace glint::daemon {

// Looks at the machine and the sensor; each returns what it could find and throws nothing for what
// it could not.

/// The kernel's counters now.
NetworkCounters count_network();
/// Everything but the counters.
HostFacts look_at_host(std::uint16_t lidar_port, std::uint16_t imu_port, const RouteLookup& route);
/// Asks the sensor; takes up to some seconds. @throws InputError when `host` is no address.
SensorFacts look_at_sensor(const std::string& host);

/// Listens on the ports and, with the right to, on the wire.
class PacketLook {
 public:
  std::uint16_t lidar_port = 0;
  std::uint16_t imu_port = 0;
  std::string source_address;      ///< Only its packets; empty: all.
  std::optional<SensorInfo> info;  ///< To know the packets by; null: all are others.
  double seconds = 1.5;

  [[nodiscard]] PacketFacts look() const;
};

}  // namespace glint::daemon
