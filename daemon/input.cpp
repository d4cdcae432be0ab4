// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/input.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <ctime>
#include <optional>

#include "daemon/parallel_for.hpp"
#include "daemon/replay_pacer.hpp"
#include "daemon/session_files.hpp"
#include "driver/udp_source.hpp"
#include "pcap/pcap_source.hpp"
#include "pcap/recording/recording_files.hpp"
#include "pcap/recording/recording_metadata.hpp"
#include "pcap/recording/recording_source.hpp"
#include "pcap/synth/option_keys.hpp"
#include "pcap/synth/synthetic_source.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kPcapPrefix = "pcap:";
constexpr std::string_view kSynthPrefix = "synth:";
// A simulated sensor runs until it is told otherwise.
constexpr double kForeverS = 1e8;
// It shares the machine with what it is to try out.
constexpr int kSynthThreads = 2;

/// --meta, else the configured file, else for a capture STEM.json or metadata.json beside it.
fs::path metadata_file(const InputOptions& options, const Config& config, const fs::path& capture) {
  if (!options.metadata.empty()) return options.metadata;
  if (!config.sensor.metadata_file.empty()) return config.sensor.metadata_file;
  if (capture.empty()) {
    throw ConfigError(
        "a live sensor needs its name or address, sensor.host; or, to leave it alone, its "
        "metadata: "
        "save http://SENSOR/api/v1/sensor/metadata to a file and name it with sensor.metadata_file "
        "or --meta");
  }
  fs::path stem = capture;
  stem.replace_extension(".json");
  const fs::path folder = capture.parent_path() / "metadata.json";
  for (const fs::path& file : {stem, folder}) {
    if (fs::exists(file)) return file;
  }
  throw ConfigError(
      fmt::format("there is no metadata for {}: neither {} nor {}; name it with --meta",
                  capture.string(), stem.string(), folder.string()));
}

std::uint16_t to_port(int port) { return static_cast<std::uint16_t>(port); }

void log_sentences(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) spdlog::warn("{}", sentence);
}

std::unique_ptr<PacketSource> open_capture(const fs::path& file, const SensorInfo& info,
                                           const InputOptions& options, const Config& config) {
  PcapSourceOptions source_options;
  if (const auto rate = parse_rate(options.rate)) {
    source_options.pacer = [pacer = std::make_shared<ReplayPacer>(*rate)](HostTime time) {
      return pacer->wait(time);
    };
  }
  if (recording::is_recording(file)) {
    return std::make_unique<recording::RecordingSource>(
        file, info, recording::RecordingSourceOptions{"", source_options.pacer});
  }
  if (const std::string address = source_filter(config.sensor); !address.empty()) {
    source_options.source_ip = IpAddress::parse(address);
    if (!source_options.source_ip) {
      throw ConfigError(fmt::format("sensor.source_address = \"{}\" is no IP address",
                                    config.sensor.source_address));
    }
  }
  return std::make_unique<PcapSource>(file, info, source_options);
}

/// The configured ports, else those of the metadata, else the usual ones.
UdpPorts udp_ports(const std::optional<SensorInfo>& info, const Config::Sensor& sensor) {
  UdpPorts ports;
  if (info) ports = {to_port(info->lidar_port), to_port(info->imu_port)};
  if (sensor.lidar_port > 0) ports.lidar = to_port(sensor.lidar_port);
  if (sensor.imu_port > 0) ports.imu = to_port(sensor.imu_port);
  return ports;
}

std::unique_ptr<UdpSource> open_udp(UdpPorts ports, const Config::Sensor& sensor) try {
  UdpSourceOptions options;
  options.bind_address = sensor.bind_address;
  options.multicast_group = sensor.multicast_group;
  options.source_address = source_filter(sensor);
  options.lidar_port = ports.lidar;
  options.imu_port = ports.imu;
  options.rcvbuf_bytes = sensor.rcvbuf_bytes;
  auto source = std::make_unique<UdpSource>(options);
  if (source->granted_rcvbuf_bytes() < sensor.rcvbuf_bytes) {
    spdlog::warn(
        "the kernel grants a receive buffer of {} of {} bytes; packets may be lost; run: "
        "sysctl -w net.core.rmem_max={}",
        source->granted_rcvbuf_bytes(), sensor.rcvbuf_bytes, sensor.rcvbuf_bytes);
  }
  return source;
} catch (const AddressError& error) {
  // Others, of an interface that is not up yet for one, may come right by themselves.
  throw ConfigError(fmt::format("[sensor] {}", error.what()));
}

/// From a file, or from inside a recording if there is none.
SensorInfo capture_info(const InputOptions& options, const Config& config, const fs::path& file) {
  std::optional<std::string> inside;
  if (options.metadata.empty() && config.sensor.metadata_file.empty() &&
      recording::is_recording(file)) {
    inside = recording::find_metadata(file);
  }
  return inside ? parse_sensor_info(*inside, file.string())
                : load_sensor_info(metadata_file(options, config, file));
}

Input open_capture_input(const fs::path& file, const InputOptions& options, const Config& config) {
  try {
    Input input;
    input.info = capture_info(options, config, file);
    input.source = open_capture(file, *input.info, options, config);
    log_sentences(input.source->notices());
    input.options.lossless = true;
    input.options.source_name = fmt::format("pcap:{}", file.string());
    return input;
  } catch (const InputError& error) {
    throw ConfigError(error.what());
  }
}

Input open_synthetic_input(std::string_view what, const InputOptions& options) {
  try {
    synth::SimulationOptions standard;
    standard.seconds = kForeverS;
    synth::SimulationOptions simulation = synth::parse_simulation(what, standard);
    simulation.parallel_for = parallel_for(kSynthThreads);
    synth::SyntheticSource::Pacer wait;
    if (const auto rate = parse_rate(options.rate)) {
      wait = [pacer = std::make_shared<ReplayPacer>(*rate)](HostTime time) {
        return pacer->wait(time);
      };
    }
    auto source = std::make_unique<synth::SyntheticSource>(simulation, wait);
    Input input;
    input.info = source->simulator().info();
    input.options.lossless = true;
    input.options.source_name = fmt::format("synth:{}", what);
    input.source = std::move(source);
    return input;
  } catch (const InputError& error) {
    throw ConfigError(fmt::format("--source synth:{}: {}", what, error.what()));
  }
}

Input open_live_input(const InputOptions& options, const Config& config) {
  Input input;
  const bool metadata_given = !options.metadata.empty() || !config.sensor.metadata_file.empty();
  try {
    if (metadata_given || config.sensor.host.empty()) {
      input.info = load_sensor_info(metadata_file(options, config, {}));
    }
  } catch (const InputError& error) {
    throw ConfigError(error.what());
  }
  const UdpPorts ports = udp_ports(input.info, config.sensor);
  if (!config.sensor.host.empty()) {
    input.sensor = sensor_link_options(config.sensor, ports);
    input.sensor->take_metadata = !metadata_given;
  }
  if (const std::string idle = idle_settings(config.sensor); !idle.empty()) {
    spdlog::warn("{}", idle);
  }
  auto source = open_udp(ports, config.sensor);
  input.options.source_name = fmt::format("udp:{}", source->lidar_port());
  input.source = std::move(source);
  return input;
}

}  // namespace

Input open_input(const InputOptions& options, const Config& config) {
  const std::string_view source = options.source;
  Input input;
  if (source.starts_with(kPcapPrefix)) {
    input = open_capture_input(source.substr(kPcapPrefix.size()), options, config);
  } else if (source.starts_with(kSynthPrefix)) {
    input = open_synthetic_input(source.substr(kSynthPrefix.size()), options);
  } else if (source == "udp") {
    input = open_live_input(options, config);
  } else {
    throw ConfigError(
        fmt::format("--source {} is none of udp, pcap:FILE and synth:WORLD", options.source));
  }
  if (input.info) log_sentences(input.info->warnings);
  return input;
}

fs::path new_session_file(const Config& config) {
  const fs::path directory = state_directory(config);
  if (directory.empty()) return {};
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    throw ConfigError(
        fmt::format("state.directory = \"{}\" cannot be made: {}; name one that this user may "
                    "write to, or \"\" "
                    "to keep no sessions",
                    directory.string(), error.message()));
  }
  const std::string stem =
      fmt::format("{}{:%Y%m%dT%H%M%SZ}", kSessionPrefix, fmt::gmtime(std::time(nullptr)));
  fs::path file = directory / fmt::format("{}{}", stem, kSessionSuffix);
  for (int i = 2; fs::exists(file); ++i) {
    file = directory / fmt::format("{}-{}{}", stem, i, kSessionSuffix);
  }
  return file;
}

}  // namespace glint::daemon
