// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint status: how the daemon fares.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/status_text.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

void print_stages(const Json& stages) {
  if (stages.empty()) return;
  fmt::print("stage ms   {:<18}{:>9}{:>9}{:>9}\n", "", "last", "mean", "max");
  for (const auto& [name, ms] : stages.items()) {
    fmt::print("           {:<18}{:>9.2f}{:>9.2f}{:>9.2f}\n", name, ms["last"].get<double>(),
               ms["mean"].get<double>(), ms["max"].get<double>());
  }
}

/// What runs now.
void print_jobs(const Json& jobs) {
  for (const Json& job : jobs) {
    if (job["state"] != "running") continue;
    fmt::print("job        {} {}, {:.0f} %\n", job["kind"].get<std::string>(), job["id"].dump(),
               100.0 * job["progress"].get<double>());
  }
}

void print_status(const Json& status) {
  const Json& counters = status["counters"];
  const Json& map = status["map"];
  fmt::print("state      {}\n", status["state"].get<std::string>());
  fmt::print(
      "sensor     {} ({}){}\n", status["sensor_state"].get<std::string>(),
      status["source"].get<std::string>(),
      status.contains("sensor_error") ? ": " + status["sensor_error"].get<std::string>() : "");
  if (status.contains("sensor_session") && status["sensor_session"].contains("failure")) {
    fmt::print("           {}\n", status["sensor_session"]["failure"].get<std::string>());
  }
  if (status.contains("age_ms")) {
    fmt::print("last pose  {} s, {:.0f} ms ago\n", status["t"].get<std::string>(),
               status["age_ms"].get<double>());
  }
  fmt::print("packets    {} lidar, {} IMU; {} scans, {} poses\n",
             counters["lidar_packets"].get<std::uint64_t>(),
             counters["imu_packets"].get<std::uint64_t>(), counters["scans"].get<std::uint64_t>(),
             counters["poses"].get<std::uint64_t>());
  fmt::print("losses     {}\n", losses_text(counters));
  fmt::print("map        {} points in {} tiles, {} keyframes, epoch {}\n",
             map["points"].get<std::uint64_t>(), map["tiles"].get<std::uint64_t>(),
             map["keyframes"].get<std::uint64_t>(), status["map_epoch"].get<int>());
  print_stages(status["stage_ms"]);
  const auto session = status["session_file"].get<std::string>();
  fmt::print("session    {}\n", session.empty() ? "not kept" : session);
  print_jobs(status.value("jobs", Json::array()));
  fmt::print("daemon     glintd {}, up {:.0f} s, {} clients, {:.0f} MB\n",
             status["version"].get<std::string>(), status["uptime_s"].get<double>(),
             status["clients"].get<int>(), status["rss_mb"].get<double>());
}

}  // namespace

void add_status(CLI::App& app) {
  auto options = std::make_shared<ClientOptions>();
  CLI::App* sub = app.add_subcommand("status", "Ask the daemon how it fares");
  add_client_options(*sub, *options);
  sub->callback([options] {
    with_client(*options, [&](daemon::Client& client) {
      const Json status = client.call("get_status");
      if (options->json) {
        std::cout << status.dump() << '\n';
      } else {
        print_status(status);
      }
    });
  });
}

}  // namespace glint::cli
