// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/passed_sockets.hpp"

#include <sys/socket.h>
#include <systemd/sd-daemon.h>

#include "daemon/config.hpp"

namespace glint::daemon {

PassedSockets take_passed_sockets() {
  PassedSockets passed;
  const int count = sd_listen_fds(1);
  for (int fd = SD_LISTEN_FDS_START; fd < SD_LISTEN_FDS_START + count; ++fd) {
    const bool is_unix = sd_is_socket(fd, AF_UNIX, SOCK_STREAM, 1) > 0;
    if (!is_unix && sd_is_socket_inet(fd, AF_UNSPEC, SOCK_STREAM, 1, 0) <= 0) {
      throw ConfigError(
          "systemd passes a socket that is neither a listening TCP nor a listening Unix stream "
          "socket; in glintd.socket use ListenStream and leave Accept=no");
    }
    int& place = is_unix ? passed.unix_stream : passed.tcp;
    if (place >= 0) {
      throw ConfigError(
          "systemd passes two sockets of one kind; name at most one TCP address and one path with "
          "ListenStream in glintd.socket");
    }
    place = fd;
  }
  return passed;
}

}  // namespace glint::daemon
