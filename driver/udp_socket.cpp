// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/udp_socket.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include "driver/core/error.hpp"
#include "driver/socket_address.hpp"

namespace glint {
namespace {

template <class T>
bool set_option(int socket, int level, int option, T value) {
  return setsockopt(socket, level, option, &value, sizeof value) == 0;
}

[[noreturn]] void fail_to_join(const UdpSocketOptions& options, int why) {
  const bool no_interface = why == ENODEV || why == EADDRNOTAVAIL;
  if (no_interface && options.bind_address.empty()) {
    throw InputError(
        fmt::format("no route tells the interface of the multicast group {}; give the address of "
                    "that interface as bind address",
                    options.multicast_group));
  }
  if (no_interface) {
    throw InputError(
        fmt::format("the bind address {} is none of this machine's, so the multicast group {} "
                    "cannot be joined there; \"ip address\" lists them",
                    options.bind_address, options.multicast_group));
  }
  throw InputError(fmt::format("the multicast group {} cannot be joined: {}",
                               options.multicast_group, std::strerror(why)));
}

// The options' addresses, read and checked against one another.
struct Addresses {
  explicit Addresses(const UdpSocketOptions& options);

  std::optional<SocketAddress> bind;
  std::optional<SocketAddress> group;
  // Of bind, if it is IPv6, and of the group; 0: left to the kernel.
  std::uint32_t interface = 0;
};

Addresses::Addresses(const UdpSocketOptions& options) {
  if (!options.bind_address.empty()) {
    bind = SocketAddress::parse(options.bind_address, "bind address");
    if (!bind->is_ipv4() && bind->interface == 0) bind->interface = interface_with(*bind);
    interface = bind->interface;
  }
  if (options.multicast_group.empty()) return;
  group = SocketAddress::parse(options.multicast_group, "multicast group");
  if (!group->is_multicast()) {
    throw AddressError(
        fmt::format("the multicast group {} is none: groups are 224.0.0.0 to 239.255.255.255 and "
                    "those of IPv6 that begin with ff",
                    options.multicast_group));
  }
  if (bind && bind->is_ipv4() != group->is_ipv4()) {
    throw AddressError(fmt::format(
        "the bind address {} and the multicast group {} are of different families; "
        "give the interface's {} address",
        options.bind_address, options.multicast_group, group->is_ipv4() ? "IPv4" : "IPv6"));
  }
  if (group->interface == 0) group->interface = interface;
  interface = group->interface;
  if (bind && !bind->is_ipv4() && interface == 0) fail_to_join(options, EADDRNOTAVAIL);
}

[[noreturn]] void fail_to_bind(const std::string& address, std::uint16_t port, int why) {
  switch (why) {
    case EADDRINUSE:
      throw InputError(
          fmt::format("port {} is held by another program; \"ss -ulnp sport = :{}\" names it: stop "
                      "it, let the sensor send to another port or to another address of this "
                      "machine (each program listens on its own bind address), or let it send to "
                      "a multicast group, which programs can share",
                      port, port));
    case EACCES:
      throw InputError(
          fmt::format("port {} needs privileges; let the sensor send to a port above 1023", port));
    case EADDRNOTAVAIL:
      throw InputError(fmt::format(
          "the bind address {} is none of this machine's; \"ip address\" lists them", address));
    case EINVAL:
      throw InputError(
          fmt::format("the address {} needs its interface: {}%INTERFACE; \"ip link\" "
                      "lists them",
                      address, address));
    default:
      throw InputError(fmt::format("port {} cannot be opened: {}", port, std::strerror(why)));
  }
}

Descriptor open_socket(const Addresses& addresses, int& family) {
  const auto& listen = addresses.group ? addresses.group : addresses.bind;
  family = listen && listen->is_ipv4() ? AF_INET : AF_INET6;
  constexpr int kType = SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC;
  Descriptor fd(socket(family, kType, 0));
  if (fd.get() >= 0 || listen) return fd;
  family = AF_INET;  // a machine without IPv6
  return Descriptor(socket(family, kType, 0));
}

void bind_socket(int fd, int family, const Addresses& addresses, const UdpSocketOptions& options,
                 std::uint16_t port) {
  // Bound to the group, it gets nothing but the group's datagrams; to share the port then takes
  // nothing away from anyone.
  const auto& listen = addresses.group ? addresses.group : addresses.bind;
  if (family == AF_INET6) set_option(fd, IPPROTO_IPV6, IPV6_V6ONLY, listen ? 1 : 0);
  if (addresses.group) set_option(fd, SOL_SOCKET, SO_REUSEADDR, 1);
  const BindAddress address(listen.value_or(SocketAddress{}), family, port);
  if (bind(fd, address.get(), address.size) == 0) return;
  fail_to_bind(addresses.group ? options.multicast_group : options.bind_address, port, errno);
}

// What other programs join on other interfaces shall not come too, hence each second option. To
// IPv6 a membership is of the whole host, so there the socket itself is tied to the interface.
void join_group(int fd, const Addresses& addresses, const UdpSocketOptions& options) {
  const SocketAddress& group = *addresses.group;
  if (group.is_ipv4()) {
    ip_mreqn request{};
    request.imr_multiaddr = group.ipv4();
    if (addresses.bind) request.imr_address = addresses.bind->ipv4();
    if (!set_option(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, request)) fail_to_join(options, errno);
    set_option(fd, IPPROTO_IP, IP_MULTICAST_ALL, 0);
  } else {
    const ipv6_mreq request{group.bytes, addresses.interface};
    if (!set_option(fd, IPPROTO_IPV6, IPV6_ADD_MEMBERSHIP, request)) fail_to_join(options, errno);
    set_option(fd, SOL_SOCKET, SO_BINDTOIFINDEX, static_cast<int>(addresses.interface));
  }
}

std::uint16_t bound_port(int fd) {
  // The port lies at the same place in the addresses of both families.
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  sockaddr_in named{};
  std::memcpy(&named, &address, sizeof named);
  return ntohs(named.sin_port);
}

Descriptor open_bound(const UdpSocketOptions& options, std::uint16_t port) {
  const Addresses addresses(options);
  int family = AF_INET6;
  Descriptor fd = open_socket(addresses, family);
  if (fd.get() < 0) fail_to_bind(options.bind_address, port, errno);
  // The first needs a capability and passes over the system's limit.
  if (!set_option(fd.get(), SOL_SOCKET, SO_RCVBUFFORCE, options.rcvbuf_bytes)) {
    set_option(fd.get(), SOL_SOCKET, SO_RCVBUF, options.rcvbuf_bytes);
  }
  set_option(fd.get(), SOL_SOCKET, SO_RXQ_OVFL, 1);
  set_option(fd.get(), SOL_SOCKET, SO_TIMESTAMPNS, 1);
  if (addresses.group) join_group(fd.get(), addresses, options);
  bind_socket(fd.get(), family, addresses, options, port);
  return fd;
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) close(fd_);
}

UdpSocket::UdpSocket(const UdpSocketOptions& options, std::uint16_t port)
    : fd_(open_bound(options, port)), port_(bound_port(fd_.get())) {}

int UdpSocket::granted_rcvbuf_bytes() const {
  int bytes = 0;
  socklen_t size = sizeof bytes;
  getsockopt(fd_.get(), SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes / 2;  // the kernel doubles what is asked for, for its own book-keeping
}

}  // namespace glint
