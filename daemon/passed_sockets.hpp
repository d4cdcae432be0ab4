// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

namespace glint::daemon {

/// Listening sockets that systemd opened for this process (socket activation, sd_listen_fds(3)).
/// Each takes the place of the one that the configuration names; -1: none of that kind.
struct PassedSockets {
  int tcp = -1;
  int unix_stream = -1;
};

/// Takes them, once: afterwards nothing is passed on to others. Whoever asks owns them.
/// @throws ConfigError for sockets of which nothing can be made, and for two of a kind.
PassedSockets take_passed_sockets();

}  // namespace glint::daemon
