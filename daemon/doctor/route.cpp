// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/doctor/route.hpp"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

namespace glint::daemon {
namespace {

struct RouteListDeleter {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};
struct InterfaceListDeleter {
  void operator()(ifaddrs* list) const { freeifaddrs(list); }
};

std::string numeric(const sockaddr* address, socklen_t size) {
  std::array<char, NI_MAXHOST> text{};
  if (getnameinfo(address, size, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) != 0) {
    return {};
  }
  return text.data();
}

/// The interface that has an address, by name.
std::string interface_of(const std::string& address) {
  ifaddrs* found = nullptr;
  if (getifaddrs(&found) != 0) return {};
  const std::unique_ptr<ifaddrs, InterfaceListDeleter> list(found);
  for (const ifaddrs* i = list.get(); i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr) continue;
    const int family = i->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    const socklen_t size = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
    if (numeric(i->ifa_addr, size) == address) return i->ifa_name;
  }
  // All of 127.0.0.0/8 is the loopback interface's, though it names only the first.
  return address.starts_with("127.") ? "lo" : "";
}

int mtu_of(int socket, const std::string& interface) {
  ifreq request{};
  interface.copy(static_cast<char*>(request.ifr_name), IFNAMSIZ - 1);
  return ioctl(socket, SIOCGIFMTU, &request) == 0 ? request.ifr_mtu : 0;
}

}  // namespace

RouteLookup look_up_route(const std::string& host) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), "7502", &hints, &found);
  if (error != 0) {
    return {std::nullopt, fmt::format("the name {} has no address: {}", host, gai_strerror(error))};
  }
  const std::unique_ptr<addrinfo, RouteListDeleter> list(found);
  const int udp = socket(list->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  // A connected UDP socket has the route's local address; nothing is sent.
  sockaddr_storage local{};
  socklen_t size = sizeof local;
  auto* const local_address = reinterpret_cast<sockaddr*>(&local);
  const bool connected = udp >= 0 && connect(udp, list->ai_addr, list->ai_addrlen) == 0 &&
                         getsockname(udp, local_address, &size) == 0;
  RouteLookup lookup;
  if (connected) {
    Route route{numeric(list->ai_addr, list->ai_addrlen), numeric(local_address, size), {}, 0};
    route.interface = interface_of(route.local_address);
    route.mtu = mtu_of(udp, route.interface);
    lookup.route = std::move(route);
  } else {
    lookup.failure = fmt::format("there is no route to {}: {}", host, std::strerror(errno));
  }
  if (udp >= 0) close(udp);
  return lookup;
}

}  // namespace glint::daemon
