// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/client_command.hpp"

#include <fmt/format.h>

#include "daemon/cli/command.hpp"
#include "daemon/saved_maps.hpp"

namespace glint::cli {

void add_client_options(CLI::App& command, ClientOptions& options) {
  command.add_option("--connect", options.connect, "HOST:PORT, or the path of a Unix socket")
      ->capture_default_str();
  command.add_flag("--json", options.json, "Print JSON, exactly as the daemon sent it");
}

void with_client(const ClientOptions& options, const std::function<void(daemon::Client&)>& body) {
  try {
    daemon::Client client(options.connect);
    body(client);
  } catch (const daemon::ClientError& error) {
    throw ConnectionError(error.what());
  }
}

void expect_map_name(const std::string& name) {
  if (daemon::SavedMaps::is_name(name)) return;
  throw UsageError(
      fmt::format("'{}' cannot be a map's name, which is {}", name, daemon::SavedMaps::kNameRule));
}

std::string vector_text(const daemon::Json& vector, int decimals) {
  std::string text;
  for (const auto& value : vector) {
    text += fmt::format("{}{:.{}f}", text.empty() ? "[" : ", ", value.get<double>(), decimals);
  }
  return text + "]";
}

}  // namespace glint::cli
