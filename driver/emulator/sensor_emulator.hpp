// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "driver/core/clock.hpp"
#include "driver/emulator/control_fault.hpp"
#include "driver/emulator/emulated_sensor.hpp"

namespace glint::emulator {

struct SensorEmulatorOptions {
  EmulatedSensorOptions sensor;
  std::string bind_address = "127.0.0.1";
  std::uint16_t http_port = 0;  ///< 0: any free one.
  std::uint16_t tcp_port = 0;   ///< Of the text commands; 0: any free one.
  bool powered = true;          ///< At the start; without power it refuses connections.
};

/// An emulated sensor's control side on the network: HTTP in the form of its firmware and the text
/// commands. Sends no packets: `on_stream` tells whoever does. Lives on the caller's io_context.
/// Thread-compatible: used on the thread that runs it.
class SensorEmulator {
 public:
  /// @throws MetadataError, InputError when options cannot be used or a port is held.
  SensorEmulator(boost::asio::io_context& io, const SensorEmulatorOptions& options, Clock clock,
                 std::function<void(const EmulatedStream&)> on_stream);
  ~SensorEmulator();
  SensorEmulator(const SensorEmulator&) = delete;
  SensorEmulator& operator=(const SensorEmulator&) = delete;

  /// Ports are closed and open connections cut.
  void power_off();
  /// Boots with the settings in flash.
  void power_on();
  /// Loses power for a moment.
  void restart();
  /// Spoils coming HTTP answers, in place of earlier plans.
  void inject(ControlFaultPlan plan);

  void raise_alert(const std::string& id, const std::string& category, const std::string& message);
  void clear_alerts();
  void jump_clock(std::int64_t offset_ns);

  [[nodiscard]] std::uint16_t http_port() const;
  [[nodiscard]] std::uint16_t tcp_port() const;
  [[nodiscard]] const EmulatedSensor& sensor() const;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace glint::emulator
