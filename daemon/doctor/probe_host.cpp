// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "daemon/doctor/probes.hpp"
#include "daemon/doctor/proc_text.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::optional<std::int64_t> read_number(const fs::path& file) {
  return parse_number(read_text(file));
}

std::vector<std::string> own_addresses() {
  ifaddrs* found = nullptr;
  std::vector<std::string> addresses;
  if (getifaddrs(&found) != 0) return addresses;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> list(found, &freeifaddrs);
  for (const ifaddrs* i = list.get(); i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr) continue;
    const int family = i->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    const socklen_t size = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
    std::array<char, NI_MAXHOST> text{};
    if (getnameinfo(i->ifa_addr, size, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) == 0) {
      addresses.emplace_back(text.data());
    }
  }
  return addresses;
}

/// Whether a process has this socket open; false also when that may not be looked at.
bool has_socket(const fs::path& process, std::uint64_t inode) {
  const std::string wanted = fmt::format("socket:[{}]", inode);
  std::error_code error;
  for (fs::directory_iterator at(process / "fd", error), end; !error && at != end;
       at.increment(error)) {
    std::error_code unreadable;
    if (fs::read_symlink(at->path(), unreadable) == wanted) return true;
  }
  return false;
}

std::string holder_of(std::uint64_t inode) {
  std::error_code error;
  for (fs::directory_iterator at("/proc", error), end; !error && at != end; at.increment(error)) {
    const std::string pid = at->path().filename();
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    if (!has_socket(at->path(), inode)) continue;
    std::string name = read_text(at->path() / "comm");
    name.erase(std::remove(name.begin(), name.end(), '\n'), name.end());
    return fmt::format("{} (pid {})", name, pid);
  }
  return {};
}

PortFacts look_at_port(std::uint16_t port) {
  PortFacts facts{port, false, {}};
  for (const char* file : {"/proc/net/udp", "/proc/net/udp6"}) {
    for (const UdpSocketEntry& socket : parse_udp_sockets(read_text(file))) {
      if (socket.local_port != port) continue;
      facts.held = true;
      if (facts.holder.empty()) facts.holder = holder_of(socket.inode);
    }
  }
  return facts;
}

/// The larger of the interface's and that of all: so the kernel takes it.
std::optional<std::int64_t> rp_filter(const std::string& interface) {
  const fs::path folder = "/proc/sys/net/ipv4/conf";
  const auto all = read_number(folder / "all" / "rp_filter");
  if (interface.empty()) return all;
  return std::max(all, read_number(folder / interface / "rp_filter"));
}

}  // namespace

NetworkCounters count_network() {
  const std::string snmp = read_text("/proc/net/snmp");
  return {parse_snmp(snmp, "Udp", "RcvbufErrors"), parse_snmp(snmp, "Ip", "ReasmFails")};
}

HostFacts look_at_host(std::uint16_t lidar_port, std::uint16_t imu_port, const RouteLookup& route) {
  HostFacts facts;
  facts.rmem_max_bytes = read_number("/proc/sys/net/core/rmem_max");
  facts.ipfrag_high_bytes = read_number("/proc/sys/net/ipv4/ipfrag_high_thresh");
  facts.rp_filter = rp_filter(route.route ? route.route->interface : "");
  facts.ports.push_back(look_at_port(lidar_port));
  if (imu_port != lidar_port && imu_port != 0) facts.ports.push_back(look_at_port(imu_port));
  facts.own_addresses = own_addresses();
  return facts;
}

}  // namespace glint::daemon
