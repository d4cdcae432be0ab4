// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint simulate: a simulated sensor in a simulated world, as a capture with ground truth or
// straight to the wire.
#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <memory>
#include <string>

#include "daemon/cli/command.hpp"
#include "daemon/cli/text_file.hpp"
#include "daemon/emulate/udp_sender.hpp"
#include "daemon/host_port.hpp"
#include "daemon/parallel_for.hpp"
#include "daemon/replay_pacer.hpp"
#include "driver/core/error.hpp"
#include "pcap/synth/motion/trajectory_file.hpp"
#include "pcap/synth/option_keys.hpp"
#include "pcap/synth/synthetic_source.hpp"
#include "pcap/synth/truth_files.hpp"

namespace glint::cli {
namespace {

struct SimulateOptions {
  synth::SimulationOptions simulation;
  bool seconds_given = false;
  std::string out;
  int mtu = 0;
  std::string to;
  int imu_port = 0;  ///< 0: the lidar port + 1.
  std::string pace = "1";
  std::string metadata;
  int threads = 2;
};

void show_scan(int done, int all) {
  std::cerr << fmt::format("\rscan {} of {}", done, all) << (done == all ? "\n" : "") << std::flush;
}

void print_faults(const synth::FaultCounts& faults) {
  if (faults.lost + faults.duplicated + faults.delayed == 0) return;
  std::cout << fmt::format("of {} datagrams {} were lost, {} arrived twice, {} late\n", faults.sent,
                           faults.lost, faults.duplicated, faults.delayed);
}

/// To the directory `out`.
void write_capture(const SimulateOptions& options) {
  std::function<void(int, int)> progress;
  if (isatty(STDERR_FILENO) != 0) progress = show_scan;
  const synth::FaultCounts faults =
      synth::simulate(options.simulation, options.out, options.mtu, progress);
  std::cout << fmt::format("{}, {} s, seed {}: capture, metadata and ground truth in {}\n",
                           options.simulation.world, options.simulation.seconds,
                           options.simulation.seed, options.out);
  print_faults(faults);
}

/// To the wire, at the sensor's own pace or a multiple of it.
void send(const SimulateOptions& options) {
  const auto target = daemon::parse_host_port(options.to);
  if (!target || target->port == 0) {
    throw UsageError(fmt::format(
        "--to {} is not HOST:PORT; write e.g. 127.0.0.1:7502 or [::1]:7502.", options.to));
  }
  const int imu_port = options.imu_port != 0 ? options.imu_port : target->port + 1;
  if (imu_port > 65535) throw UsageError("There is no port after 65535; name one with --imu-port.");
  const daemon::UdpSender lidar(target->host, target->port);
  const daemon::UdpSender imu(target->host, static_cast<std::uint16_t>(imu_port));
  const std::optional<double> pace = daemon::parse_rate(options.pace);
  daemon::ReplayPacer pacer(pace.value_or(1.0));
  synth::SyntheticSource::Pacer wait;
  if (pace) wait = [&pacer](HostTime time) { return pacer.wait(time); };
  synth::SyntheticSource source(options.simulation, wait);
  const SensorInfo& info = source.simulator().info();
  if (!options.metadata.empty()) write_text_file(options.metadata, to_metadata_json(info));

  RawPacket packet;
  std::uint64_t sent = 0;
  SourceStatus status = source.read(packet);
  for (; status != SourceStatus::kEnd; status = source.read(packet)) {
    if (status == SourceStatus::kIdle) continue;
    (packet.port == info.imu_port ? imu : lidar).send(packet.bytes);
    ++sent;
  }
  std::cout << fmt::format("sent {} packets to ports {} and {} of {}\n", sent, target->port,
                           imu_port, target->host);
  print_faults(source.faults());
}

void run(SimulateOptions& options) {
  if (options.out.empty() == options.to.empty()) {
    throw UsageError("Name either --out DIR for a capture or --to HOST:PORT for the wire.");
  }
  synth::SimulationOptions& simulation = options.simulation;
  simulation.parallel_for = daemon::parallel_for(options.threads);
  try {
    if (!simulation.trajectory.empty() && !options.seconds_given) {
      simulation.seconds =
          synth::load_trajectory(simulation.trajectory, simulation.sensor.rate_hz).duration_s;
    }
    options.to.empty() ? write_capture(options) : send(options);
  } catch (const synth::OptionError& error) {
    throw UsageError(error.what());
  }
}

/// Adds a flag for each of the simulation's options.
void add_simulation_options(CLI::App& command, const std::shared_ptr<SimulateOptions>& options) {
  for (const synth::OptionKey& key : synth::option_keys()) {
    const auto set = [options, &key](const std::string& text) {
      if (key.name == "seconds") options->seconds_given = true;
      try {
        key.set(options->simulation, text);
      } catch (const synth::OptionError& error) {
        throw UsageError(fmt::format("--{}", error.what()));
      }
    };
    CLI::Option* const option = command.add_option_function<std::string>(
        fmt::format("--{}", key.name), set, std::string(key.what));
    if (key.repeats) option->allow_extra_args(false)->trigger_on_parse();
    const std::string standard = key.get(options->simulation);
    if (!standard.empty()) option->default_str(standard);
  }
}

}  // namespace

void add_simulate(CLI::App& app) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* const command = app.add_subcommand(
      "simulate", "A simulated sensor: a capture with ground truth, or packets on the wire");
  std::string worlds = "Where:";
  for (const synth::WorldEntry& world : synth::world_list()) {
    worlds += fmt::format("\n{} - {}", world.name, world.what);
  }
  command->add_option("--world", options->simulation.world, worlds)->required();
  command->add_option("--out", options->out, "Directory for the files, made if need be");
  command->add_option("--to", options->to, "HOST:PORT to send lidar packets to; nothing is stored");
  add_simulation_options(*command, options);
  command
      ->add_option("--mtu", options->mtu, "Write larger packets in IP fragments, bytes; 0: don't")
      ->capture_default_str();
  command
      ->add_option("--imu-port", options->imu_port, "With --to: for IMU packets; default PORT + 1")
      ->check(CLI::Range(1, 65535));
  command->add_option("--pace", options->pace, "With --to: 1 as a sensor, 2 twice as fast, or max")
      ->capture_default_str();
  command->add_option("--metadata", options->metadata, "With --to: file for the sensor's metadata");
  command->add_option("--threads", options->threads, "Threads to cast with; the bytes are the same")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->callback([options] { run(*options); });
}

}  // namespace glint::cli
