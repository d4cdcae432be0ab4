// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace glint {

/// A file descriptor that closes itself. Thread-compatible.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

struct UdpSocketOptions {
  /// Address of the interface to listen on, IPv4 or IPv6; empty: all of them, both families.
  std::string bind_address;
  /// IPv4 or IPv6 multicast group to take datagrams of, and of nothing else; empty: none. Joined
  /// on the interface after "%" in an IPv6 group, else on that of bind_address, else on the one
  /// that the kernel's routes name.
  std::string multicast_group;
  int rcvbuf_bytes = 8 << 20;  ///< Asked for; see granted_rcvbuf_bytes().
};

/// A socket that receives on one port; it never blocks, and has the kernel tell times of arrival
/// and drops. The port is held exclusively, so that no second program can take datagrams away; that
/// of a multicast group may be shared, for there each gets all of them. Thread-compatible.
class UdpSocket {
 public:
  /// `port` 0: any free one.
  /// @throws InputError when an address is none, or the port is held or may not be used, or the
  /// group cannot be joined.
  UdpSocket(const UdpSocketOptions& options, std::uint16_t port);

  [[nodiscard]] int get() const { return fd_.get(); }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Bytes of receive buffer that the kernel grants, in the unit of rcvbuf_bytes.
  [[nodiscard]] int granted_rcvbuf_bytes() const;

 private:
  Descriptor fd_;
  std::uint16_t port_;
};

}  // namespace glint
