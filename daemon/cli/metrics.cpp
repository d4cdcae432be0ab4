// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glint metrics: the daemon's counters as Prometheus reads them.
#include <iostream>
#include <memory>

#include "daemon/cli/client_command.hpp"
#include "daemon/cli/command.hpp"

namespace glint::cli {

void add_metrics(CLI::App& app) {
  auto options = std::make_shared<ClientOptions>();
  CLI::App* sub =
      app.add_subcommand("metrics", "Print the daemon's counters in Prometheus' text format");
  add_client_options(*sub, *options);
  sub->callback([options] {
    with_client(*options, [&](daemon::Client& client) {
      const daemon::Json reply = client.call("get_metrics");
      std::cout << (options->json ? reply.dump() + "\n" : reply["text"].get<std::string>());
    });
  });
}

}  // namespace glint::cli
