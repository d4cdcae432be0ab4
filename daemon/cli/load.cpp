// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint load: has the daemon go on with a map that was saved.
#include <fmt/format.h>

#include <memory>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/job_waiting.hpp"

namespace glint::cli {
namespace {

struct LoadCommand {
  ClientOptions client;
  std::string name;
  std::string mode = "extend";
};

void load(const LoadCommand& command) {
  expect_map_name(command.name);
  with_client(command.client, [&](daemon::Client& client) {
    const daemon::Json job = run_job(client, command.client, "load_map",
                                     {{"name", command.name}, {"mode", command.mode}},
                                     fmt::format("the map {} was not loaded", command.name));
    if (command.client.json) return;
    fmt::print("{}: {} keyframes; the sensor looks for its place in it\n", command.name,
               job["result"]["keyframes"].get<std::size_t>());
  });
}

}  // namespace

void add_load(CLI::App& app) {
  auto command = std::make_shared<LoadCommand>();
  CLI::App* sub = app.add_subcommand("load", "Have the daemon go on with a map that was saved");
  add_client_options(*sub, command->client);
  sub->add_option("name", command->name, "Its name; glint maps --connect lists all")->required();
  sub->add_option("--mode", command->mode,
                  "extend: the map goes on to grow; localize: it is only read")
      ->check(CLI::IsMember({"extend", "localize"}))
      ->capture_default_str();
  sub->callback([command] { load(*command); });
}

}  // namespace glint::cli
