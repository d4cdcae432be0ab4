// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <netdb.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace glint::daemon {

/// Sends datagrams to one address, IPv4 or IPv6. Nobody need listen there. Thread-compatible.
class UdpSender {
 public:
  /// `from`: this machine's address to send from, empty for the one of the route.
  /// @throws InputError if the host has no address or no socket can be opened.
  UdpSender(const std::string& host, std::uint16_t port, const std::string& from = {});
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// Sends one datagram; waits while the kernel's buffer is full.
  /// @throws std::runtime_error with a sentence when it cannot be sent.
  void send(std::span<const std::byte> datagram) const;
  /// The same; false when it cannot be sent, errno says why.
  [[nodiscard]] bool try_send(std::span<const std::byte> datagram) const;

 private:
  bool open(const addrinfo& target, const std::string& from);

  const std::string target_;  ///< For messages.
  int socket_ = -1;
};

}  // namespace glint::daemon
