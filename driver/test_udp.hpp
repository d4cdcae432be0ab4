// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "driver/socket_address.hpp"
#include "driver/udp_source.hpp"

namespace glint::test {

/// A socket of its own that sends as a sensor does, from an address of this machine.
class UdpSender {
 public:
  explicit UdpSender(const std::string& from = "127.0.0.1")
      : from_(SocketAddress::parse(from, "sender")),
        family_(from_.is_ipv4() ? AF_INET : AF_INET6),
        fd_(socket(family_, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const BindAddress own(from_, family_, 0);
    // To IPv4 the source address tells where multicast goes out, to IPv6 it does not.
    const std::uint32_t interface = interface_with(from_);
    if (family_ == AF_INET6) {
      setsockopt(fd_, IPPROTO_IPV6, IPV6_MULTICAST_IF, &interface, sizeof interface);
    }
    if (bind(fd_, own.get(), own.size) != 0) throw std::runtime_error("cannot send from " + from);
  }
  ~UdpSender() { close(fd_); }
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  bool send(const std::string& to, std::uint16_t port, const std::vector<std::byte>& bytes) const {
    const BindAddress target(SocketAddress::parse(to, "target"), family_, port);
    return sendto(fd_, bytes.data(), bytes.size(), 0, target.get(), target.size) ==
           static_cast<ssize_t>(bytes.size());
  }
  /// To the host it sends from.
  bool send(std::uint16_t port, const std::vector<std::byte>& bytes) const {
    return send(from_.is_ipv4() ? "127.0.0.1" : "::1", port, bytes);
  }

 private:
  const SocketAddress from_;
  const int family_;
  const int fd_;
};

inline UdpSourceOptions any_port() {
  UdpSourceOptions options;
  options.lidar_port = 0;
  options.imu_port = 0;
  return options;
}

inline std::uint16_t free_port() { return UdpSource(any_port()).lidar_port(); }

inline std::vector<std::byte> payload(std::size_t size, int value) {
  return std::vector<std::byte>(size, static_cast<std::byte>(value));
}

/// The next packet's first byte; none when none comes within some time.
inline std::optional<int> first_byte(UdpSource& source) {
  RawPacket packet;
  if (source.read(packet) != SourceStatus::kPacket) return std::nullopt;
  return std::to_integer<int>(packet.bytes.at(0));
}

}  // namespace glint::test
