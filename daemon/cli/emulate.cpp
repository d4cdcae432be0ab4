// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint emulate: a sensor on the wire, by a capture of one.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "daemon/cli/capture_input.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/emulate/emulation.hpp"
#include "daemon/emulate/udp_sender.hpp"
#include "daemon/host_port.hpp"
#include "daemon/replay_pacer.hpp"
#include "driver/core/error.hpp"

namespace glint::cli {
namespace {

struct EmulateOptions {
  CaptureInput input;
  std::string to;
  std::string rate = "1";
  int imu_port = 0;  ///< 0: the lidar port + 1.
  std::string loop;  ///< Empty: once, or for ever when there is a control side.
  std::optional<std::uint16_t> http_port;
  std::optional<std::uint16_t> tcp_port;
  std::string bind;
  std::string firmware;
  double boot_s = 2.0;
  double reinitialise_s = 1.0;
  std::string scenario;
  double delay_s = 0.0;
  daemon::EmulationOptions emulation;

  [[nodiscard]] bool has_control() const { return http_port || tcp_port || !scenario.empty(); }
};

std::int64_t to_ns(double seconds) { return std::llround(seconds / kSecondsPerNs); }

/// Where packets go to by --to and --imu-port.
void take_destination(EmulateOptions& options) {
  if (options.to.empty()) {
    if (options.has_control()) return;
    throw UsageError(
        "Name where packets go to with --to HOST:PORT, or give the sensor a control "
        "side with --http PORT.");
  }
  const auto target = daemon::parse_host_port(options.to);
  if (!target || target->port == 0) {
    throw UsageError(
        fmt::format("--to {} is not HOST:PORT; write e.g. 127.0.0.1:7502 or "
                    "[::1]:7502.",
                    options.to));
  }
  const int imu_port = options.imu_port != 0 ? options.imu_port : target->port + 1;
  if (imu_port > 65535) throw UsageError("There is no port after 65535; name one with --imu-port.");
  options.emulation.destination = target->host;
  options.emulation.lidar_port = target->port;
  options.emulation.imu_port = static_cast<std::uint16_t>(imu_port);
  // Tells what is wrong with the address before anything starts.
  const daemon::UdpSender probe(target->host, target->port, options.bind);
}

void take_loops(EmulateOptions& options) {
  if (options.loop.empty()) {
    options.emulation.loops = options.has_control() ? 0 : 1;
  } else if (options.loop == "forever") {
    options.emulation.loops = 0;
  } else {
    options.emulation.loops = std::stoull(options.loop);
  }
}

emulator::SensorEmulatorOptions control_options(const EmulateOptions& options,
                                                const SensorInfo& info) {
  emulator::SensorEmulatorOptions control;
  control.sensor.metadata_json = load_capture_metadata(options.input);
  if (!options.to.empty()) {
    const daemon::EmulationOptions& to = options.emulation;
    control.sensor.config_changes = {{"udp_dest", to.destination},
                                     {"udp_port_lidar", to.lidar_port},
                                     {"udp_port_imu", to.imu_port}};
  }
  control.sensor.firmware = options.firmware;
  if (options.firmware.empty() && info.firmware.empty()) control.sensor.firmware = "v2.5.0";
  control.sensor.boot_ns = to_ns(options.boot_s);
  control.sensor.reinitialise_ns = to_ns(options.reinitialise_s);
  if (!options.bind.empty()) control.bind_address = options.bind;
  control.http_port = options.http_port.value_or(0);
  control.tcp_port = options.tcp_port.value_or(0);
  return control;
}

void print_summary(const daemon::EmulationResult& result, const EmulateOptions& options) {
  const daemon::EmulationCounts& packets = result.packets;
  if (options.has_control()) {
    fmt::print("sent {} lidar packets and {} IMU packets in {} streams; {} config writes\n",
               packets.lidar.delivered, packets.imu.delivered, packets.starts,
               result.sensor.config_writes);
  } else {
    const daemon::EmulationOptions& to = options.emulation;
    fmt::print("sent {} lidar packets to port {} and {} IMU packets to port {} of {} in {:.3f} s\n",
               packets.lidar.delivered, to.lidar_port, packets.imu.delivered, to.imu_port,
               to.destination, result.seconds);
  }
  const std::uint64_t lost = packets.lidar.lost + packets.imu.lost;
  const std::uint64_t duplicated = packets.lidar.duplicated + packets.imu.duplicated;
  const std::uint64_t delayed = packets.lidar.delayed + packets.imu.delayed;
  if (lost + duplicated + delayed > 0) {
    fmt::print("{} were lost, {} arrived twice, {} late\n", lost, duplicated, delayed);
  }
}

void emulate(EmulateOptions& options) {
  take_destination(options);
  take_loops(options);
  daemon::EmulationOptions& emulation = options.emulation;
  emulation.rate = daemon::parse_rate(options.rate);
  emulation.from = options.bind;
  emulation.faults.delay_ns = to_ns(options.delay_s);
  if (!options.scenario.empty()) emulation.scenario = emulator::load_scenario(options.scenario);
  const SensorInfo info = load_capture_info(options.input);
  if (options.has_control()) emulation.control = control_options(options, info);
  emulation.on_listening = [](std::uint16_t http_port, std::uint16_t tcp_port) {
    fmt::print("emulated sensor: HTTP on port {}, text commands on port {}\n", http_port, tcp_port);
    static_cast<void>(std::fflush(stdout));
  };
  const auto capture = open_capture(options.input, info);
  const daemon::EmulationResult result = daemon::emulate(*capture, info, emulation);
  print_notices(capture->notices());
  print_summary(result, options);
}

/// CLI11 wants the complaint as a string, empty for none.
std::string check_rate(const std::string& text) {
  try {
    static_cast<void>(daemon::parse_rate(text));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string check_loop(const std::string& text) {
  const bool digits = !text.empty() && text.size() < 10 &&
                      text.find_first_not_of("0123456789") == std::string::npos;
  if (text == "forever" || (digits && std::stoull(text) > 0)) return {};
  return "write a number from 1 on, or forever";
}

void add_line_options(CLI::App& command, EmulateOptions& options) {
  const CLI::Range share(0.0, 0.999);
  emulator::PacketFaults& faults = options.emulation.faults;
  command.add_option("--loss", faults.loss, "Share of packets that the network loses")
      ->check(share);
  command
      .add_option("--reordering", faults.reordering,
                  "Share of packets that arrive one to three late")
      ->check(share);
  command.add_option("--duplicates", faults.duplicates, "Share of packets that arrive twice")
      ->check(share);
  command.add_option("--delay", options.delay_s, "How long packets are on the way, s")
      ->check(CLI::Range(0.0, 10.0));
  command.add_option("--seed", options.emulation.seed, "Of what happens by chance")
      ->capture_default_str();
}

void add_control_options(CLI::App& command, EmulateOptions& options) {
  command.add_option("--http", options.http_port,
                     "Port of the sensor's HTTP interface, 0 for any: settings take effect");
  command.add_option("--tcp", options.tcp_port, "Port of its text commands, 0 for any");
  command.add_option("--bind", options.bind,
                     "The sensor's own address, of this machine; default 127.0.0.1 for its "
                     "interface, and that of the route for packets");
  command.add_option("--firmware", options.firmware,
                     "Its firmware, e.g. v3.1.0; default: that of the metadata");
  command.add_option("--boot", options.boot_s, "How long it takes to start, s")
      ->check(CLI::Range(0.0, 600.0))
      ->capture_default_str();
  command
      .add_option("--reinitialise", options.reinitialise_s,
                  "How long it takes to apply settings, s")
      ->check(CLI::Range(0.0, 600.0))
      ->capture_default_str();
  command.add_option("--scenario", options.scenario,
                     "TOML file of what befalls the sensor and its network, and when");
}

}  // namespace

void add_emulate(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("emulate", "A sensor on the wire: a capture's packets, and its interface");
  const auto options = std::make_shared<EmulateOptions>();
  add_capture_options(*command, options->input);
  command->add_option("--to", options->to,
                      "HOST:PORT that lidar packets go to; default with --http: the metadata's");
  command->add_option("--rate", options->rate, "Speed: 1 as recorded, 2 twice as fast, or max")
      ->check(check_rate)
      ->capture_default_str();
  command->add_option("--imu-port", options->imu_port, "Port for IMU packets; default PORT + 1")
      ->check(CLI::Range(1, 65535));
  command
      ->add_option("--loop", options->loop,
                   "Times to send the capture's whole scans as one stream, or forever; default 1, "
                   "with --http forever")
      ->check(check_loop);
  command->add_option("--seconds", options->emulation.seconds, "Stop after so long, s")
      ->check(CLI::PositiveNumber);
  command->add_option("--report", options->emulation.report,
                      "JSON file of everything that was sent, lost, doubled; written every second");
  add_line_options(*command, *options);
  add_control_options(*command, *options);
  command->callback([options] { emulate(*options); });
}

}  // namespace glint::cli
