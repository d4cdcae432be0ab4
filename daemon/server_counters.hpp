// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

namespace glint::daemon {

/// What the server did and what it turned away, since the start. Main thread.
struct ServerCounters {
  std::uint64_t accepted_clients = 0;
  std::uint64_t refused_clients = 0;  ///< One too many, or no room left for those without a token.
  std::uint64_t failed_accepts = 0;   ///< The process or the system had no room for a client.
  std::uint64_t junk_clients = 0;     ///< Closed: another protocol, or too long a line.
  std::uint64_t idle_clients = 0;     ///< Closed: they asked for nothing for too long.
  std::uint64_t slow_clients = 0;     ///< Closed: they did not take what waited for them.
  std::uint64_t failed_handshakes = 0;       ///< TLS did not come about, or not in time.
  std::uint64_t failed_authentications = 0;  ///< Wrong tokens.
  std::uint64_t requests = 0;
  std::uint64_t bad_requests = 0;          ///< Lines that are no request.
  std::uint64_t forbidden_requests = 0;    ///< The client's token does not give the right.
  std::uint64_t throttled_requests = 0;    ///< Had to wait for server.max_requests_per_s.
  std::uint64_t missed_notifications = 0;  ///< That clients were too slow for.
  std::uint64_t unsent_poses = 0;          ///< That the main thread was too slow for.
  std::uint64_t scrapes = 0;               ///< HTTP requests to metrics.listen.
  std::uint64_t refused_scrapes = 0;  ///< Not HTTP, too slow, too large, or too many at a time.
};

}  // namespace glint::daemon
