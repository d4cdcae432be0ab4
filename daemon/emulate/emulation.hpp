// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "daemon/emulate/emulation_counts.hpp"
#include "driver/core/packet_source.hpp"
#include "driver/core/sensor_info.hpp"
#include "driver/emulator/scenario.hpp"
#include "driver/emulator/scenario_player.hpp"
#include "driver/emulator/sensor_emulator.hpp"

namespace glint::daemon {

struct EmulationOptions {
  /// The sensor's control side, and packets as it has them sent; null: packets only.
  std::optional<emulator::SensorEmulatorOptions> control;
  emulator::Scenario scenario;  ///< Needs a control side.
  /// Where packets go to without a control side.
  std::string destination;
  std::uint16_t lidar_port = 0;
  std::uint16_t imu_port = 0;

  std::optional<double> rate = 1.0;  ///< Times the recorded speed; null: as fast as it goes.
  std::uint64_t loops = 1;           ///< 0: for ever.
  std::string from;                  ///< Own address to send from; empty: that of the route.
  emulator::PacketFaults faults;
  std::uint64_t seed = 1;         ///< Of the faults.
  std::optional<double> seconds;  ///< Null: until it ends, or a signal comes.
  std::filesystem::path report;   ///< Written every second and at the end; empty: none.
  /// Told once the control side listens.
  std::function<void(std::uint16_t http_port, std::uint16_t tcp_port)> on_listening;
};

/// What an emulation did. Value type.
struct EmulationResult {
  EmulationCounts packets;
  emulator::EmulatorCounts sensor;  ///< Zero without a control side.
  double seconds = 0.0;
};

/// As written to the report.
nlohmann::ordered_json to_json(const EmulationResult& result);

/// Emulates a sensor by a capture until it ends, time is up, or SIGINT or SIGTERM comes. With a
/// control side or more than one loop its whole scans are sent as one endless stream with new ids
/// and times; else its packets as they are.
/// @throws InputError when something cannot be used, std::runtime_error when sending fails.
EmulationResult emulate(PacketSource& capture, const SensorInfo& info,
                        const EmulationOptions& options);

}  // namespace glint::daemon
