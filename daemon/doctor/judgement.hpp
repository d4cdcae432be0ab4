// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include "daemon/doctor/facts.hpp"
#include "daemon/doctor/finding.hpp"

namespace glint::daemon {

// From facts to findings; pure functions. Each finding that is not OK names the line that mends it.

/// Whether this machine reaches the sensor, and how.
Finding judge_route(const RouteLookup& lookup, const DoctorWishes& wishes);
/// Whether the sensor answers, is well, and sends here.
Findings judge_sensor(const SensorFacts& sensor, const HostFacts& host, const DoctorWishes& wishes);
/// Whether the ports can be had.
Findings judge_ports(const HostFacts& host);
/// Whether packets arrive. `sensor` and `route` as far as known.
Findings judge_packets(const PacketFacts& packets, const HostFacts& host, const SensorFacts& sensor,
                       const RouteLookup& route);
/// Buffers, and what the kernel lost.
Findings judge_buffers(const HostFacts& host, const DoctorWishes& wishes);
/// Whether packets fit the network; nothing when that is not known.
Findings judge_fragments(const RouteLookup& route, const SensorFacts& sensor);
/// Gravity at rest against the mounting; nothing without IMU packets.
Findings judge_gravity(const PacketFacts& packets, const DoctorWishes& wishes);

}  // namespace glint::daemon
