// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "driver/socket_address.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <array>
#include <cstring>
#include <memory>

#include "driver/core/error.hpp"

namespace glint {
namespace {

in6_addr map_ipv4(const in_addr& v4) {
  in6_addr mapped{};
  mapped.s6_addr[10] = mapped.s6_addr[11] = 0xFF;
  std::memcpy(&mapped.s6_addr[12], &v4, sizeof v4);
  return mapped;
}

bool same_bytes(const in6_addr& a, const in6_addr& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

SocketAddress SocketAddress::parse(const std::string& text, const char* what) {
  SocketAddress address;
  in_addr v4{};
  if (inet_pton(AF_INET, text.c_str(), &v4) == 1) {
    address.bytes = map_ipv4(v4);
    return address;
  }
  const auto percent = text.find('%');
  if (inet_pton(AF_INET6, text.substr(0, percent).c_str(), &address.bytes) != 1) {
    throw AddressError(
        fmt::format("the {} {} is no IP address; write it like 192.0.2.5, 2001:db8::5 or "
                    "fe80::5%eth0",
                    what, text));
  }
  if (percent == std::string::npos) return address;
  address.interface = if_nametoindex(text.substr(percent + 1).c_str());
  if (address.interface == 0) {
    throw InputError(
        fmt::format("the {} {} names an interface that is none of this machine's; \"ip link\" "
                    "lists them",
                    what, text));
  }
  return address;
}

SocketAddress SocketAddress::of(const sockaddr_storage& from) {
  if (from.ss_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &from, sizeof v6);
    return {v6.sin6_addr, v6.sin6_scope_id};
  }
  sockaddr_in v4{};
  std::memcpy(&v4, &from, sizeof v4);
  return {map_ipv4(v4.sin_addr), 0};
}

bool SocketAddress::is_ipv4() const { return IN6_IS_ADDR_V4MAPPED(&bytes); }

bool SocketAddress::is_multicast() const {
  return is_ipv4() ? IN_MULTICAST(ntohl(ipv4().s_addr)) : IN6_IS_ADDR_MULTICAST(&bytes);
}

in_addr SocketAddress::ipv4() const {
  in_addr v4{};
  std::memcpy(&v4, &bytes.s6_addr[12], sizeof v4);
  return v4;
}

bool SocketAddress::matches(const SocketAddress& other) const {
  return same_bytes(bytes, other.bytes) &&
         (interface == 0 || other.interface == 0 || interface == other.interface);
}

BindAddress::BindAddress(const SocketAddress& address, int family, std::uint16_t port) {
  if (family == AF_INET) {
    sockaddr_in v4{};
    v4.sin_family = AF_INET;
    v4.sin_port = htons(port);
    v4.sin_addr = address.ipv4();
    std::memcpy(&storage, &v4, size = sizeof v4);
  } else {
    sockaddr_in6 v6{};
    v6.sin6_family = AF_INET6;
    v6.sin6_port = htons(port);
    v6.sin6_addr = address.bytes;
    v6.sin6_scope_id = address.interface;
    std::memcpy(&storage, &v6, size = sizeof v6);
  }
}

// The sockets API takes every kind of address through this one pointer type.
const sockaddr* BindAddress::get() const { return reinterpret_cast<const sockaddr*>(&storage); }

std::uint32_t interface_with(const SocketAddress& address) {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return 0;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> list(first, freeifaddrs);
  for (const ifaddrs* i = first; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr) continue;
    const int family = i->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    sockaddr_storage own{};
    std::memcpy(&own, i->ifa_addr, family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6));
    if (SocketAddress::of(own).matches(address)) return if_nametoindex(i->ifa_name);
  }
  return 0;
}

}  // namespace glint
