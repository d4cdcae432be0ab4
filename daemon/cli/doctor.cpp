// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint doctor: looks along the way from the sensor to the program and says what is wrong where.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "daemon/cli/command.hpp"
#include "daemon/client.hpp"
#include "daemon/config_layers.hpp"
#include "daemon/doctor/judgement.hpp"
#include "daemon/doctor/probes.hpp"
#include "driver/session/sensor_address.hpp"

namespace glint::cli {
namespace {

using daemon::Finding;
using daemon::FindingLevel;
using daemon::Findings;
using daemon::Json;

constexpr std::uint16_t kUsualLidarPort = 7502;
constexpr std::uint16_t kUsualImuPort = 7503;

struct DoctorOptions {
  std::string sensor;
  std::string config;
  std::string connect;
  double seconds = 1.5;
  bool json = false;
};

void append(Findings& findings, Findings more) {
  for (Finding& finding : more) findings.push_back(std::move(finding));
}

/// What a running daemon says of its sensor.
Findings ask_daemon(const std::string& connect) {
  const std::string step = "daemon";
  try {
    daemon::Client client(connect);
    const Json status = client.call("get_status");
    const std::string state = status.value("sensor_state", "unknown");
    if (state != "RUNNING") {
      return {{FindingLevel::kFail, step,
               fmt::format("glintd's sensor is {}: {}", state,
                           status.value("sensor_error", "no packet has come")),
               "see glint status"}};
    }
    const Json counters = status.value("counters", Json::object());
    const auto drops = counters.value("kernel_drops", std::uint64_t{0});
    if (drops > 0) {
      return {{FindingLevel::kWarn, step,
               fmt::format("the kernel dropped {} of glintd's packets", drops),
               "raise sensor.rcvbuf_bytes and net.core.rmem_max"}};
    }
    return {{FindingLevel::kOk, step, "glintd receives packets, none dropped by the kernel", {}}};
  } catch (const std::runtime_error& error) {
    return {{FindingLevel::kFail, step, error.what(), "start glintd, or leave out --connect"}};
  }
}

Findings examine(const DoctorOptions& options) {
  const daemon::Config config = daemon::read_config_layers(options.config, {}).config;
  daemon::DoctorWishes wishes{config.sensor.rcvbuf_bytes, config.mount.T_base_sensor,
                              options.sensor};
  Findings findings;
  daemon::RouteLookup route;
  daemon::SensorFacts sensor;
  if (!options.sensor.empty()) {
    route = daemon::look_up_route(parse_sensor_address(options.sensor).host);
    findings.push_back(daemon::judge_route(route, wishes));
    if (route.route) sensor = daemon::look_at_sensor(options.sensor);
  }
  const auto port = [](int wanted, const std::optional<SensorInfo>& info, auto member,
                       std::uint16_t usual) {
    if (wanted != 0) return static_cast<std::uint16_t>(wanted);
    return info ? static_cast<std::uint16_t>((*info).*member) : usual;
  };
  daemon::PacketLook look;
  look.lidar_port =
      port(config.sensor.lidar_port, sensor.info, &SensorInfo::lidar_port, kUsualLidarPort);
  look.imu_port = port(config.sensor.imu_port, sensor.info, &SensorInfo::imu_port, kUsualImuPort);
  look.source_address = route.route ? route.route->address : "";
  look.info = sensor.info;
  look.seconds = options.seconds;

  daemon::HostFacts host = daemon::look_at_host(look.lidar_port, look.imu_port, route);
  host.before = daemon::count_network();
  const daemon::PacketFacts packets = look.look();
  host.after = daemon::count_network();

  if (route.route) append(findings, daemon::judge_sensor(sensor, host, wishes));
  append(findings, daemon::judge_ports(host));
  append(findings, daemon::judge_packets(packets, host, sensor, route));
  if (!options.connect.empty()) append(findings, ask_daemon(options.connect));
  append(findings, daemon::judge_buffers(host, wishes));
  append(findings, daemon::judge_fragments(route, sensor));
  append(findings, daemon::judge_gravity(packets, wishes));
  return findings;
}

void print(const Findings& findings) {
  for (const Finding& finding : findings) {
    fmt::print("{:<5}{:<16}{}{}\n", daemon::to_string(finding.level), finding.step, finding.what,
               finding.mend.empty() ? "" : "; mend: " + finding.mend);
  }
}

void print_json(const Findings& findings) {
  Json rows = Json::array();
  for (const Finding& finding : findings) {
    Json row{{"level", daemon::to_string(finding.level)},
             {"step", finding.step},
             {"what", finding.what}};
    if (!finding.mend.empty()) row["mend"] = finding.mend;
    rows.push_back(std::move(row));
  }
  Json out{{"findings", std::move(rows)}};
  if (const Finding* failure = daemon::first_failure(findings)) {
    out["first_failure"] = failure->step + ": " + failure->what;
  }
  std::cout << out.dump(2) << '\n';
}

void doctor(const DoctorOptions& options) {
  const Findings findings = examine(options);
  options.json ? print_json(findings) : print(findings);
  const Finding* const failure = daemon::first_failure(findings);
  if (failure == nullptr) {
    if (!options.json) fmt::print("Nothing fails.\n");
    return;
  }
  // The exit code is 1 with it.
  throw std::runtime_error(fmt::format("the first step that fails is the {}: {}; mend: {}",
                                       failure->step, failure->what, failure->mend));
}

}  // namespace

void add_doctor(CLI::App& app) {
  CLI::App* const command = app.add_subcommand(
      "doctor", "Look along the way from the sensor to this machine, and say what is wrong where");
  const auto options = std::make_shared<DoctorOptions>();
  command->add_option("--sensor", options->sensor,
                      "The sensor's name or address, if need be :PORT");
  command->add_option("--config", options->config,
                      fmt::format("glintd's settings, for ports and mounting; default {} if it is "
                                  "there",
                                  daemon::kUsualConfigFile));
  command->add_option("--connect", options->connect,
                      "Also ask a running glintd: HOST:PORT, or the path of a Unix socket");
  command->add_option("--seconds", options->seconds, "How long to listen for packets, s")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options] { doctor(*options); });
}

}  // namespace glint::cli
