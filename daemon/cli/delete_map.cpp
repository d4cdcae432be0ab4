// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint delete-map: has the daemon remove a map that was saved.
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"

namespace glint::cli {
namespace {

struct DeleteMapCommand {
  ClientOptions client;
  std::string name;
};

void delete_map(const DeleteMapCommand& command) {
  expect_map_name(command.name);
  with_client(command.client, [&](daemon::Client& client) {
    const daemon::Json reply = client.call("delete_map", {{"name", command.name}});
    if (command.client.json) {
      std::cout << reply.dump() << '\n';
    } else {
      fmt::print("{}: deleted\n", command.name);
    }
  });
}

}  // namespace

void add_delete_map(CLI::App& app) {
  auto command = std::make_shared<DeleteMapCommand>();
  CLI::App* sub = app.add_subcommand("delete-map", "Delete a map that the daemon saved");
  add_client_options(*sub, command->client);
  sub->add_option("name", command->name, "Its name, see glint maps --connect")->required();
  sub->callback([command] { delete_map(*command); });
}

}  // namespace glint::cli
