// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>
#include <string>

namespace glint::daemon {

/// How packets go to a host. Value type.
struct Route {
  std::string address;        ///< The host's, numeric.
  std::string local_address;  ///< This machine's on that route.
  std::string interface;      ///< "eth0"; empty when not found.
  int mtu = 0;                ///< Of the interface, bytes; 0 when not found.
};

/// What a look-up gave: a route, or a sentence on why there is none.
struct RouteLookup {
  std::optional<Route> route;
  std::string failure;
};

/// Looks up a name or address and the kernel's route to it. Sends nothing but the name's look-up.
RouteLookup look_up_route(const std::string& host);

}  // namespace glint::daemon
