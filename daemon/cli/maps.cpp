// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint maps: the sessions of a directory, or the maps that the daemon saved, a line each.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"
#include "daemon/session_files.hpp"
#include "driver/core/time.hpp"

namespace glint::cli {
namespace {

namespace fs = std::filesystem;
using daemon::Json;

struct MapsCommand {
  fs::path directory = ".";
  ClientOptions client;
};

void print_line(const std::string& what, const Json& session) {
  const auto saved_s =
      static_cast<std::time_t>(session["saved_ns"].get<std::int64_t>() / kNsPerSecond);
  fmt::print("{}: {} keyframes in {} segments, {} loops, {:.0f} m in {:.0f} s, {:.1f} MB, {}\n",
             what, session["keyframes"].get<std::size_t>(), session["segments"].get<std::size_t>(),
             session["loops"].get<std::size_t>(), session["way_m"].get<double>(),
             session["duration_s"].get<double>(), session["bytes"].get<double>() / 1e6,
             fmt::format("{:%Y-%m-%d %H:%M:%S UTC}", fmt::gmtime(saved_s)));
}

/// `key`: what each one is called by.
void print_lines(const Json& all, const char* key) {
  for (const Json& session : all) {
    if (session.contains("error")) {
      fmt::print("{}\n", session["error"].get<std::string>());
    } else {
      print_line(session[key].get<std::string>(), session);
    }
  }
}

void list_files(const MapsCommand& command) {
  Json all = Json::array();
  for (const fs::path& file : daemon::session_files(command.directory)) {
    Json session{{"file", file.string()}};
    session.update(daemon::describe_session(file));
    all.push_back(std::move(session));
  }
  if (command.client.json) {
    std::cout << all.dump() << '\n';
    return;
  }
  if (all.empty()) fmt::print("no sessions (*.glint) in {}\n", command.directory.string());
  print_lines(all, "file");
}

void list_maps(const MapsCommand& command) {
  with_client(command.client, [&](daemon::Client& client) {
    const Json reply = client.call("list_maps");
    if (command.client.json) {
      std::cout << reply.dump() << '\n';
      return;
    }
    const Json& maps = reply.at("maps");
    if (maps.empty()) fmt::print("no maps were saved; glint save NAME saves one\n");
    print_lines(maps, "name");
  });
}

}  // namespace

void add_maps(CLI::App& app) {
  auto command = std::make_shared<MapsCommand>();
  CLI::App* sub =
      app.add_subcommand("maps", "List the sessions of a directory, or the daemon's maps");
  add_client_options(*sub, command->client);
  CLI::Option* connect =
      sub->get_option("--connect")
          ->description("List the maps of the daemon at HOST:PORT, or the path of a Unix socket");
  sub->get_option("--json")->description("Print JSON");
  sub->add_option("directory", command->directory, "Where to look (default: here)")
      ->excludes(connect);
  sub->callback(
      [command, connect] { connect->count() > 0 ? list_maps(*command) : list_files(*command); });
}

}  // namespace glint::cli
