// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint watch: notifications as they come, a line each.
#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <memory>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/monitor.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

struct WatchCommand {
  ClientOptions client;
  std::vector<std::string> topics = {"pose"};
  std::string frame = "map";
  std::string child = "sensor";
  double rate_hz = 0.0;
  std::uint64_t count = 0;
  bool monitor = false;
};

std::string pose_line(const Json& pose) {
  if (!pose.contains("p_m")) return pose["state"].get<std::string>();
  return fmt::format("{} {:<10} {} m {} m/s{}", pose["t"].get<std::string>(),
                     pose["state"].get<std::string>(), vector_text(pose["p_m"], 3),
                     vector_text(pose["v_mps"], 2),
                     pose["missed"] > 0 ? fmt::format(" (missed {})", pose["missed"].dump()) : "");
}

std::string status_line(const Json& status) {
  return fmt::format("status {} sensor {}, {} poses, {} map points, {} packets missing",
                     status["state"].get<std::string>(), status["sensor_state"].get<std::string>(),
                     status["counters"]["poses"].dump(), status["map"]["points"].dump(),
                     status["counters"]["missing_packets"].dump());
}

void print(const Json& message, bool json) {
  const Json& params = message.at("params");
  if (json) {
    std::cout << params.dump() << '\n';
  } else {
    std::cout << (message["method"] == "pose" ? pose_line(params) : status_line(params)) << '\n';
  }
  std::cout.flush();
  if (!std::cout) throw std::runtime_error("standard output is closed");
}

void run(const WatchCommand& command) {
  with_client(command.client, [&](daemon::Client& client) {
    Json params{{"topics", command.topics}, {"frame", command.frame}, {"child", command.child}};
    if (command.rate_hz > 0.0) params["rate_hz"] = command.rate_hz;
    client.call("subscribe", params);
    for (std::uint64_t seen = 0; command.count == 0 || seen < command.count;) {
      const Json message = client.next_message();
      if (!message.contains("method")) continue;
      print(message, command.client.json);
      ++seen;
    }
  });
}

}  // namespace

void add_watch(CLI::App& app) {
  auto command = std::make_shared<WatchCommand>();
  CLI::App* sub = app.add_subcommand("watch", "Print poses and status as the daemon tells them");
  add_client_options(*sub, command->client);
  sub->add_option("--topics", command->topics, "pose, status, or both with a comma")
      ->delimiter(',')
      ->check(CLI::IsMember({"pose", "status"}))
      ->capture_default_str();
  sub->add_option("--frame", command->frame, "map or odom")
      ->check(CLI::IsMember({"map", "odom"}))
      ->capture_default_str();
  sub->add_option("--child", command->child, "sensor or base")
      ->check(CLI::IsMember({"sensor", "base"}))
      ->capture_default_str();
  sub->add_option("--rate-hz", command->rate_hz, "At most so many a second (default: every pose)")
      ->check(CLI::Range(0.01, 1000.0));
  sub->add_option("--count", command->count, "Stop after so many lines (default: never)");
  sub->add_flag("--monitor", command->monitor,
                "Show state, rates, losses, times, map and events on the whole terminal instead")
      ->excludes("--json", "--count");
  sub->callback([command] { command->monitor ? run_monitor(command->client) : run(*command); });
}

}  // namespace glint::cli
