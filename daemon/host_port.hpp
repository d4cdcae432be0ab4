// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace glint::daemon {

/// Where a TCP server listens: "127.0.0.1:7788", "localhost:7788", "[::1]:7788". Value type.
struct HostPort {
  std::string host;  ///< Without brackets.
  std::uint16_t port = 0;
};

/// Null when `text` is not HOST:PORT.
std::optional<HostPort> parse_host_port(std::string_view text);

}  // namespace glint::daemon
