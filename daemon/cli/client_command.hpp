// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "daemon/client.hpp"

namespace glint::cli {

/// What every client of the daemon takes.
struct ClientOptions {
  std::string connect = "127.0.0.1:7788";
  bool json = false;
  std::string tls_ca_file;
  std::string token_file;
};

/// Adds --connect, --json, --tls-ca and --token-file. `options` must outlive the parsing.
void add_client_options(CLI::App& command, ClientOptions& options);

/// Connects and runs `body`. @throws ConnectionError when the daemon cannot be reached.
void with_client(const ClientOptions& options, const std::function<void(daemon::Client&)>& body);

/// @throws UsageError when the daemon would not take `name` as a map's name.
void expect_map_name(const std::string& name);

/// "[1.250, -0.031, 0.002]".
std::string vector_text(const daemon::Json& vector, int decimals);

}  // namespace glint::cli
