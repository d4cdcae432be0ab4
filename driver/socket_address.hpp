// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <string>

namespace glint {

/// An IPv4 or IPv6 address as the sockets API takes and tells it. IPv4 is kept in its IPv6-mapped
/// form, so that one comparison serves both families. Value type.
struct SocketAddress {
  in6_addr bytes{};             ///< Network order.
  std::uint32_t interface = 0;  ///< Index of the interface after "%", IPv6 only; 0: none was said.

  /// Reads "192.0.2.5", "2001:db8::5", "fe80::5%eth0".
  /// @throws InputError, which calls the text `what`, when it is no address or the interface is
  /// none of this machine's.
  static SocketAddress parse(const std::string& text, const char* what);
  /// The address in what the kernel tells of a datagram's sender.
  static SocketAddress of(const sockaddr_storage& from);

  [[nodiscard]] bool is_ipv4() const;
  [[nodiscard]] bool is_multicast() const;
  /// The IPv4 address of the mapped form.
  [[nodiscard]] in_addr ipv4() const;
  /// The same host: equal bytes, and no two different interfaces.
  [[nodiscard]] bool matches(const SocketAddress& other) const;
};

/// What bind() takes for an address and a port.
struct BindAddress {
  /// `family`: AF_INET, which needs a mapped address, or AF_INET6.
  BindAddress(const SocketAddress& address, int family, std::uint16_t port);

  [[nodiscard]] const sockaddr* get() const;

  sockaddr_storage storage{};
  socklen_t size = 0;
};

/// Index of this machine's interface that has the address; 0 if none has.
std::uint32_t interface_with(const SocketAddress& address);

}  // namespace glint
