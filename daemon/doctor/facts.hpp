// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/doctor/route.hpp"
#include "driver/core/pose.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/session/sensor_health.hpp"

namespace glint::daemon {

/// What the kernel counted since the machine started. Value type; null where it does not say.
struct NetworkCounters {
  std::optional<std::uint64_t> receive_buffer_errors;
  std::optional<std::uint64_t> reassembly_failures;
};

/// One of the ports that packets come to. Value type.
struct PortFacts {
  std::uint16_t port = 0;
  bool held = false;
  std::string holder;  ///< "glintd (pid 812)"; empty when that may not be known.
};

/// What was found of this machine. Value type; null where it does not say.
struct HostFacts {
  std::optional<std::int64_t> rmem_max_bytes;
  std::optional<std::int64_t> ipfrag_high_bytes;
  std::optional<std::int64_t> rp_filter;  ///< In force on the interface: 0 none, 1 strict, 2 loose.
  NetworkCounters before;                 ///< The look at packets,
  NetworkCounters after;                  ///< and after it.
  std::vector<PortFacts> ports;
  std::vector<std::string> own_addresses;
};

/// What the sensor said. Value type.
struct SensorFacts {
  std::string failure;  ///< Why it cannot be asked; empty when it answers.
  std::string product_line;
  std::string serial_number;
  std::string firmware;
  std::string status;
  std::string udp_dest;
  std::string operating_mode;
  std::string timestamp_mode;
  std::optional<SensorInfo> info;  ///< Its metadata.
  std::string info_failure;        ///< Why they cannot be used.
  std::vector<SensorAlert> alerts;
  std::optional<PtpState> ptp;
  std::optional<SensorTimeState> time;
};

/// What arrived during a look. Value type.
struct PacketFacts {
  double seconds = 0.0;
  bool listened = false;  ///< On the ports; not when they are held.
  std::uint64_t lidar = 0;
  std::uint64_t imu = 0;
  std::uint64_t other = 0;
  std::size_t other_bytes = 0;           ///< Size of one of the others.
  std::optional<std::uint64_t> on_wire;  ///< Seen before any firewall; null without the right to.
  /// What the accelerometer measured at rest; null when it moved, or too little came.
  std::optional<Eigen::Vector3d> up_mps2;
};

/// What findings depend on besides. Value type.
struct DoctorWishes {
  int rcvbuf_bytes = 8 << 20;
  Pose T_base_sensor;
  std::string sensor;  ///< As named by the user; empty for none.
};

}  // namespace glint::daemon
