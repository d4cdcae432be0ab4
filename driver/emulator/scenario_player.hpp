// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>

#include "driver/emulator/scenario.hpp"
#include "driver/emulator/sensor_emulator.hpp"

namespace glint::emulator {

/// What the network does to packets from now on. Value type.
struct PacketFaults {
  double loss = 0.0;  ///< Shares of all packets, 0 to below 1.
  double reordering = 0.0;
  double duplicates = 0.0;
  std::int64_t delay_ns = 0;
};

/// Whoever sends the emulated sensor's packets, as far as a scenario has to do with it. What its
/// power and clock do to the stream is told by EmulatedStream.
class PacketFaultSink {
 public:
  virtual ~PacketFaultSink() = default;
  virtual void set_faults(const PacketFaults& faults) = 0;
  /// Packets from another address, at once.
  virtual void send_foreign(std::uint64_t count) = 0;
};

/// Lets the events of a scenario happen when their time has come. Thread-compatible.
class ScenarioPlayer {
 public:
  /// Both must outlive the player. `faults` are those that the network has already.
  ScenarioPlayer(Scenario scenario, SensorEmulator& emulator, PacketFaultSink& packets,
                 const PacketFaults& faults = {});

  /// Lets everything happen that is due so long after the start, in the order of its times. Returns
  /// when the next event is due; null when there is none.
  std::optional<std::int64_t> play(std::int64_t elapsed_ns);

 private:
  void apply(const ScenarioEvent& event);

  Scenario events_;  ///< Still to come; a repeated one with its next time.
  SensorEmulator& emulator_;
  PacketFaultSink& packets_;
  PacketFaults faults_;
};

}  // namespace glint::emulator
