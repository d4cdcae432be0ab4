// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint pose: where the sensor is now.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

struct PoseCommand {
  ClientOptions client;
  std::string frame = "map";
  std::string child = "sensor";
};

void print_pose(const Json& pose) {
  if (!pose.contains("p_m")) {
    fmt::print("state        {}\nno pose yet: no scan has arrived (glint status tells why)\n",
               pose["state"].get<std::string>());
    return;
  }
  fmt::print("state        {}{}\n", pose["state"].get<std::string>(),
             pose["stale"].get<bool>() ? " (stale: no newer scan)" : "");
  fmt::print("time         {} s ({} clock), {:.0f} ms ago\n", pose["t"].get<std::string>(),
             pose["clock"].get<std::string>(), pose["age_ms"].get<double>());
  fmt::print("frames       {} in {}, map epoch {}\n", pose["child"].get<std::string>(),
             pose["frame"].get<std::string>(), pose["map_epoch"].get<int>());
  fmt::print("position     {} m\n", vector_text(pose["p_m"], 3));
  fmt::print("orientation  {} (x y z w)\n", vector_text(pose["q_xyzw"], 5));
  fmt::print("velocity     {} m/s, {} rad/s\n", vector_text(pose["v_mps"], 3),
             vector_text(pose["w_radps"], 3));
  fmt::print("scan         frame_id {}, {:.1f} % complete\n", pose["frame_id"].get<std::uint32_t>(),
             100.0 * pose["completeness"].get<double>());
}

void run(const PoseCommand& command) {
  with_client(command.client, [&](daemon::Client& client) {
    const Json pose = client.call("get_pose", {{"frame", command.frame}, {"child", command.child}});
    if (command.client.json) {
      std::cout << pose.dump() << '\n';
    } else {
      print_pose(pose);
    }
  });
}

}  // namespace

void add_pose(CLI::App& app) {
  auto command = std::make_shared<PoseCommand>();
  CLI::App* sub = app.add_subcommand("pose", "Ask the daemon for the newest pose");
  add_client_options(*sub, command->client);
  sub->add_option("--frame", command->frame, "map or odom")
      ->check(CLI::IsMember({"map", "odom"}))
      ->capture_default_str();
  sub->add_option("--child", command->child, "sensor or base")
      ->check(CLI::IsMember({"sensor", "base"}))
      ->capture_default_str();
  sub->callback([command] { run(*command); });
}

}  // namespace glint::cli
