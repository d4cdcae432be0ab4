// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint pause, resume, reset, clear: what the daemon is told in a word.
#include <fmt/format.h>

#include <array>
#include <iostream>
#include <memory>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"

namespace glint::cli {
namespace {

using daemon::Json;

struct Word {
  const char* command;
  const char* method;
  const char* help;
  const char* done;
};

constexpr std::array kWords = {
    Word{"pause", "pause", "Have the daemon leave scans aside until it is told to resume",
         "scans are left aside; glint resume goes on"},
    Word{"resume", "resume", "Have a paused daemon go on", "scans are used again"},
    Word{"reset", "reset_odometry", "Have the daemon begin odometry anew; the map stays",
         "odometry begins anew"},
    Word{"clear", "clear_map", "Have the daemon begin an empty map; the session so far stays",
         "an empty map is begun; glint watch tells"},
};

void tell(const ClientOptions& options, const Word& word) {
  with_client(options, [&](daemon::Client& client) {
    const Json reply = client.call(word.method);
    if (options.json) {
      std::cout << reply.dump() << '\n';
    } else {
      fmt::print("{}\n", word.done);
    }
  });
}

}  // namespace

void add_control(CLI::App& app) {
  for (const Word& word : kWords) {
    auto options = std::make_shared<ClientOptions>();
    CLI::App* sub = app.add_subcommand(word.command, word.help);
    add_client_options(*sub, *options);
    sub->callback([options, &word] { tell(*options, word); });
  }
}

}  // namespace glint::cli
