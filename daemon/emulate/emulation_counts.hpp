// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace glint::daemon {

/// What became of the packets of one kind. Value type.
struct PacketCounts {
  std::uint64_t sent = 0;        ///< By the sensor, before the network.
  std::uint64_t lost = 0;        ///< By the network.
  std::uint64_t delayed = 0;     ///< Arrived one to three packets late.
  std::uint64_t duplicated = 0;  ///< Arrived twice.
  std::uint64_t delivered = 0;   ///< Datagrams that arrived, copies included.
  std::uint64_t failed = 0;      ///< That this machine could not send.
};

/// Everything that an emulated sensor's sender did. Value type.
struct EmulationCounts {
  PacketCounts lidar;
  PacketCounts imu;
  std::uint64_t scans = 0;             ///< Fed whole to the network.
  std::uint64_t cut_packets = 0;       ///< Lidar packets that scans lacked when sending stopped.
  std::uint64_t not_sent = 0;          ///< Lidar packets of the time in which it did not send.
  std::uint64_t starts = 0;            ///< Of the stream.
  std::uint64_t clock_jumps = 0;       ///< While sending.
  std::uint64_t foreign_address = 0;   ///< Lidar packets from another address,
  std::uint64_t foreign_size = 0;      ///< a byte short,
  std::uint64_t foreign_serial = 0;    ///< of another serial number.
  std::int64_t worst_lateness_ns = 0;  ///< Of a packet behind its time.
};

/// As it stands in a report.
nlohmann::ordered_json to_json(const EmulationCounts& counts);

}  // namespace glint::daemon
