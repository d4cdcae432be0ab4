// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint save: has the daemon save its map, and waits until it is on the disk.
#include <fmt/format.h>

#include <memory>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/cli/job_waiting.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

struct SaveCommand {
  ClientOptions client;
  std::string name;
};

void save(const SaveCommand& command) {
  expect_map_name(command.name);
  with_client(command.client, [&](daemon::Client& client) {
    const Json job = run_job(client, command.client, "save_map", {{"name", command.name}},
                             fmt::format("the map {} was not saved", command.name));
    if (command.client.json) return;
    const Json& map = job["result"];
    fmt::print("{}: {:.1f} MB in {:.1f} s, checksum {}\n", command.name,
               map["bytes"].get<double>() / 1e6, map["seconds"].get<double>(),
               map["checksum"].get<std::string>());
  });
}

}  // namespace

void add_save(CLI::App& app) {
  auto command = std::make_shared<SaveCommand>();
  CLI::App* sub = app.add_subcommand("save", "Save the daemon's map under a name");
  add_client_options(*sub, command->client);
  sub->add_option("name", command->name, "Its name; a map that has it already is replaced")
      ->required();
  sub->callback([command] { save(*command); });
}

}  // namespace glint::cli
