// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/emulator/sensor_emulator.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/tcp.hpp>
#include <utility>

#include "driver/core/error.hpp"
#include "driver/emulator/control_connections.hpp"
#include "driver/emulator/control_port.hpp"
#include "driver/emulator/emulator_core.hpp"

namespace glint::emulator {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

tcp::endpoint endpoint_of(const std::string& address, std::uint16_t port) {
  error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  if (!error) return {parsed, port};
  throw InputError(fmt::format(
      "the emulated sensor cannot listen on '{}'; write an IP address, e.g. 127.0.0.1", address));
}

}  // namespace

struct SensorEmulator::Impl {
  Impl(asio::io_context& io, const SensorEmulatorOptions& options, Clock clock,
       std::function<void(const EmulatedStream&)> on_stream)
      : core(io, options.sensor, clock, std::move(on_stream)),
        http(io, endpoint_of(options.bind_address, options.http_port), core),
        lines(io, endpoint_of(options.bind_address, options.tcp_port), core) {}

  void open() {
    http.open();
    lines.open();
  }
  void close() {
    http.close();
    lines.close();
  }

  EmulatorCore core;
  ControlPort<HttpConnection> http;
  ControlPort<LineConnection> lines;
};

SensorEmulator::SensorEmulator(asio::io_context& io, const SensorEmulatorOptions& options,
                               Clock clock, std::function<void(const EmulatedStream&)> on_stream)
    : impl_(std::make_shared<Impl>(io, options, clock, std::move(on_stream))) {
  impl_->open();
  if (options.powered) {
    impl_->core.schedule();
  } else {
    power_off();  // Its ports are known from here on.
  }
}

SensorEmulator::~SensorEmulator() { impl_->close(); }

void SensorEmulator::power_off() {
  impl_->close();
  impl_->core.sensor().power_off();
  impl_->core.schedule();
}

void SensorEmulator::power_on() {
  impl_->close();
  impl_->open();
  impl_->core.sensor().power_on();
  impl_->core.schedule();
}

void SensorEmulator::restart() {
  power_off();
  power_on();
}

void SensorEmulator::inject(ControlFaultPlan plan) { impl_->core.inject(std::move(plan)); }

void SensorEmulator::raise_alert(const std::string& id, const std::string& category,
                                 const std::string& message) {
  impl_->core.sensor().raise_alert(id, category, message);
}

void SensorEmulator::clear_alerts() { impl_->core.sensor().clear_alerts(); }

void SensorEmulator::jump_clock(std::int64_t offset_ns) {
  impl_->core.sensor().jump_clock(offset_ns);
}

std::uint16_t SensorEmulator::http_port() const { return impl_->http.port(); }
std::uint16_t SensorEmulator::tcp_port() const { return impl_->lines.port(); }
const EmulatedSensor& SensorEmulator::sensor() const { return impl_->core.sensor(); }

}  // namespace glint::emulator
