// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <span>
#include <thread>

#include "daemon/doctor/probes.hpp"
#include "daemon/steady_clock.hpp"
#include "driver/core/error.hpp"
#include "driver/core/gravity.hpp"
#include "driver/core/imu_packet.hpp"
#include "driver/core/packet_format.hpp"
#include "driver/udp_source.hpp"

namespace glint::daemon {
namespace {

constexpr int kPoll_ms = 50;

/// The destination port of a UDP datagram's first fragment; null of anything else.
std::optional<std::uint16_t> udp_port(std::span<const std::uint8_t> ip) {
  constexpr std::size_t kV6HeaderBytes = 40;
  if (ip.empty()) return std::nullopt;
  std::size_t udp_at = 0;
  if (ip[0] >> 4U == 4) {
    if (ip.size() < 20 || ip[9] != IPPROTO_UDP) return std::nullopt;
    const unsigned fragment = (ip[6] & 0x1FU) << 8U | ip[7];
    if (fragment != 0) return std::nullopt;
    udp_at = std::size_t{ip[0] & 0x0FU} * 4;
  } else if (ip[0] >> 4U == 6) {
    if (ip.size() < kV6HeaderBytes) return std::nullopt;
    const bool fragment = ip[6] == IPPROTO_FRAGMENT;
    udp_at = kV6HeaderBytes + (fragment ? 8 : 0);
    if (ip.size() < udp_at) return std::nullopt;
    if (fragment && ((ip[42] << 8U | ip[43]) & 0xFFF8) != 0) return std::nullopt;
    if ((fragment ? ip[kV6HeaderBytes] : ip[6]) != IPPROTO_UDP) return std::nullopt;
  } else {
    return std::nullopt;
  }
  if (ip.size() < udp_at + 4) return std::nullopt;
  return static_cast<std::uint16_t>(ip[udp_at + 2] << 8U | ip[udp_at + 3]);
}

/// Packets to the ports as they come off the interfaces, before any filter. Null without the right.
std::optional<std::uint64_t> count_on_wire(const PacketLook& look, std::int64_t end_ns) {
  const int wire = socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_ALL));
  if (wire < 0) return std::nullopt;
  std::uint64_t count = 0;
  std::array<std::uint8_t, 64> start{};
  while (steady_now_ns() < end_ns) {
    pollfd readable{wire, POLLIN, 0};
    if (poll(&readable, 1, kPoll_ms) <= 0) continue;
    sockaddr_ll from{};
    socklen_t size = sizeof from;
    const ssize_t bytes =
        recvfrom(wire, start.data(), start.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (bytes <= 0 || from.sll_pkttype == PACKET_OUTGOING) continue;
    const auto port = udp_port(std::span(start).first(static_cast<std::size_t>(bytes)));
    if (port == look.lidar_port || port == look.imu_port) ++count;
  }
  close(wire);
  return count;
}

void take(const RawPacket& packet, const PacketLook& look, PacketFacts& facts,
          GravityEstimate& gravity) {
  const std::size_t size = packet.bytes.size();
  if (look.info && size == PacketFormat(*look.info).packet_bytes) {
    ++facts.lidar;
    return;
  }
  std::vector<ImuSample> samples;
  const bool is_imu =
      look.info ? parse_imu_packet(ImuPacketFormat(*look.info), packet.bytes, samples) : false;
  if (is_imu) {
    ++facts.imu;
    for (const ImuSample& sample : samples) gravity.add(sample);
    return;
  }
  ++facts.other;
  facts.other_bytes = std::max(facts.other_bytes, size);
}

void listen(const PacketLook& look, std::int64_t end_ns, PacketFacts& facts) {
  try {
    UdpSourceOptions options;
    options.lidar_port = look.lidar_port;
    options.imu_port = look.imu_port;
    options.source_address = look.source_address;
    UdpSource source(options);
    facts.listened = true;
    RawPacket packet;
    GravityEstimate gravity;
    while (steady_now_ns() < end_ns) {
      const SourceStatus status = source.read(packet);
      if (status == SourceStatus::kPacket) take(packet, look, facts, gravity);
      if (status == SourceStatus::kEnd || status == SourceStatus::kError) break;
    }
    facts.up_mps2 = gravity.up_mps2();
  } catch (const InputError&) {
    facts.listened = false;  // Held; the ports' findings tell by whom.
  }
}

}  // namespace

PacketFacts PacketLook::look() const {
  PacketFacts facts;
  facts.seconds = seconds;
  const std::int64_t end_ns = steady_now_ns() + static_cast<std::int64_t>(seconds / kSecondsPerNs);
  std::thread wire([&] { facts.on_wire = count_on_wire(*this, end_ns); });
  listen(*this, end_ns, facts);
  wire.join();
  return facts;
}

}  // namespace glint::daemon
