// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint save: has the daemon save its map, and waits until it is on the disk.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

struct SaveCommand {
  ClientOptions client;
  std::string name;
};

/// The status comes once a second: silence for so long is a daemon that hangs.
constexpr std::chrono::seconds kSilence{10};

/// What a notification says of the job; null when it says nothing.
std::optional<Json> news_of(std::uint64_t id, const Json& message) {
  if (!message.contains("params")) return std::nullopt;
  const Json& params = message["params"];
  if (params.contains("job") && params["job"]["id"] == id) return params["job"];
  for (const Json& job : params.value("jobs", Json::array())) {
    if (job["id"] == id) return job;
  }
  return std::nullopt;
}

/// The job as it ended. Events tell its way; the status does, too, were events missed.
Json wait_for_end(daemon::Client& client, Json job, bool show_progress) {
  const auto id = job["id"].get<std::uint64_t>();
  while (job["state"] == "running") {
    const auto news = news_of(id, client.next_message(kSilence));
    if (!news) continue;
    job = *news;
    if (show_progress) fmt::print(stderr, "\r{:3.0f} %", 100.0 * job["progress"].get<double>());
  }
  if (show_progress) fmt::print(stderr, "\r     \r");
  return job;
}

void save(const SaveCommand& command) {
  expect_map_name(command.name);
  with_client(command.client, [&](daemon::Client& client) {
    client.call("subscribe", {{"topics", {"events", "status"}}});
    const Json reply = client.call("save_map", {{"name", command.name}});
    const bool show_progress = !command.client.json && isatty(STDERR_FILENO) != 0;
    const Json job = wait_for_end(client, reply.at("job"), show_progress);
    if (command.client.json) std::cout << job.dump() << '\n';
    if (job["state"] != "done") {
      throw std::runtime_error(fmt::format("the map {} was not saved: {}", command.name,
                                           job.value("error", job["state"].dump())));
    }
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
