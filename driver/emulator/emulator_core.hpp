// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "driver/core/clock.hpp"
#include "driver/emulator/control_fault.hpp"
#include "driver/emulator/emulated_sensor.hpp"

namespace glint::emulator {

/// An emulated sensor with its timer and its faults, as its connections see it. Thread-compatible:
/// used on the thread that runs the io_context.
class EmulatorCore {
 public:
  EmulatorCore(boost::asio::io_context& io, const EmulatedSensorOptions& options, Clock clock,
               std::function<void(const EmulatedStream&)> on_stream);

  EmulatedAnswer answer(const EmulatedRequest& request);
  std::string answer_line(std::string_view line, const std::string& client_address);
  /// What is to go wrong with the answer to this request; null for nothing.
  std::optional<ControlFault> next_fault(std::string_view target);
  void inject(ControlFaultPlan plan);

  /// Has the sensor updated now and whenever something of it is due.
  void schedule();
  EmulatedSensor& sensor() { return sensor_; }

 private:
  const Clock clock_;
  boost::asio::steady_timer timer_;
  EmulatedSensor sensor_;
  ControlFaultPlan faults_{ControlFault::kServerError, 0, {}};
  const std::shared_ptr<int> alive_ = std::make_shared<int>();  ///< For the timer's handler.
};

}  // namespace glint::emulator
