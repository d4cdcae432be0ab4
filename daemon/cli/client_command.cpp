// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/client_command.hpp"

#include <fmt/format.h>

#include <fstream>

#include "daemon/cli/command.hpp"
#include "daemon/saved_maps.hpp"
#include "driver/core/error.hpp"

namespace glint::cli {
namespace {

std::string read_token(const std::string& file) {
  if (file.empty()) return {};
  std::ifstream in(file);
  std::string token;
  if (!(in >> token)) throw InputError(fmt::format("{} holds no token", file));
  return token;
}

void expect_token(const ClientOptions& options, const daemon::Json& hello) {
  if (!options.token_file.empty() || hello.value("authentication", "none") == "none") return;
  throw daemon::ClientError(
      fmt::format("glintd at {} asks for a token: name a file with one with --token-file or in "
                  "GLINT_TOKEN_FILE",
                  options.connect));
}

}  // namespace

void add_client_options(CLI::App& command, ClientOptions& options) {
  command.add_option("--connect", options.connect, "HOST:PORT, or the path of a Unix socket")
      ->capture_default_str();
  command.add_option("--tls-ca", options.tls_ca_file,
                     "Speak TLS; PEM file of who vouches for the daemon's certificate");
  command.add_option("--token-file", options.token_file, "File whose first line is the token")
      ->envname("GLINT_TOKEN_FILE");
  command.add_flag("--json", options.json, "Print JSON, exactly as the daemon sent it");
}

void with_client(const ClientOptions& options, const std::function<void(daemon::Client&)>& body) {
  try {
    daemon::Client client(options.connect, {options.tls_ca_file, read_token(options.token_file)});
    expect_token(options, client.hello());
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
