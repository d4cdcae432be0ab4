// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint wait: returns once the daemon knows where the sensor is, for what is to begin after that.
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"

namespace glint::cli {
namespace {

using daemon::Json;
using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBetweenLooks{200};

struct WaitCommand {
  ClientOptions client;
  double timeout_s = 0.0;
};

bool is_localized(const Json& pose) {
  return pose.contains("p_m") && (pose["state"] == "TRACKING" || pose["state"] == "DEGRADED");
}

void run(const WaitCommand& command) {
  const auto begin = SteadyClock::now();
  std::string why;
  while (true) {
    // The daemon itself may be yet to come, or come anew.
    try {
      bool there = false;
      with_client(command.client, [&](daemon::Client& client) {
        const Json pose = client.call("get_pose", {{"frame", "map"}});
        there = is_localized(pose);
        why = fmt::format("its state is {}", pose["state"].get<std::string>());
        if (there && command.client.json) std::cout << pose.dump() << '\n';
      });
      if (there) return;
    } catch (const ConnectionError& error) {
      why = error.what();
    }
    const std::chrono::duration<double> waited = SteadyClock::now() - begin;
    if (command.timeout_s > 0.0 && waited.count() > command.timeout_s) {
      throw std::runtime_error(fmt::format(
          "the daemon has not told a place in the map for {:.0f} s: {}; glint status tells more",
          command.timeout_s, why));
    }
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

}  // namespace

void add_wait(CLI::App& app) {
  auto command = std::make_shared<WaitCommand>();
  CLI::App* sub = app.add_subcommand("wait", "Wait until the daemon knows its place in the map");
  add_client_options(*sub, command->client);
  sub->add_option("--timeout", command->timeout_s, "Longest time, s; 0: for ever")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  sub->callback([command] { run(*command); });
}

}  // namespace glint::cli
