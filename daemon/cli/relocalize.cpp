// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint relocalize: has the daemon look for the sensor's place in the map anew.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <vector>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

struct RelocalizeCommand {
  ClientOptions client;
  std::vector<double> near_m;
  double sigma_m = 3.0;
};

void relocalize(const RelocalizeCommand& command) {
  with_client(command.client, [&](daemon::Client& client) {
    const Json reply = command.near_m.empty()
                           ? client.call("relocalize")
                           : client.call("set_initial_pose",
                                         {{"p_m", command.near_m}, {"sigma_m", command.sigma_m}});
    if (command.client.json) {
      std::cout << reply.dump() << '\n';
    } else {
      fmt::print("the sensor's place in the map is looked for anew; glint watch tells\n");
    }
  });
}

}  // namespace

void add_relocalize(CLI::App& app) {
  auto command = std::make_shared<RelocalizeCommand>();
  CLI::App* sub =
      app.add_subcommand("relocalize", "Have the daemon look for its place in the map anew");
  add_client_options(*sub, command->client);
  CLI::Option* near =
      sub->add_option("--near", command->near_m, "X Y Z in the map, m: looked at first")
          ->expected(3);
  sub->add_option("--sigma-m", command->sigma_m, "How far off that may be, one deviation")
      ->needs(near)
      ->capture_default_str();
  sub->callback([command] { relocalize(*command); });
}

}  // namespace glint::cli
