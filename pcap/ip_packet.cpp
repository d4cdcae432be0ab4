// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/ip_packet.hpp"

#include <algorithm>

namespace glint {
namespace {

constexpr std::size_t kIpv4HeaderBytes = 20;
constexpr std::size_t kIpv6HeaderBytes = 40;

IpAddress load_address(Bytes bytes, std::size_t at, bool is_v6) {
  IpAddress address;
  address.is_v6 = is_v6;
  const Bytes source = bytes.subspan(at, is_v6 ? 16 : 4);
  std::copy(source.begin(), source.end(), address.bytes.begin());
  return address;
}

ParseStatus parse_ipv4(Bytes bytes, IpPacket& packet) {
  if (bytes.size() < kIpv4HeaderBytes) return ParseStatus::kTruncated;
  const std::size_t header_bytes = (bytes[0] & 0x0FU) * std::size_t{4};
  // Captures of a machine whose card splits large packets have 0 as the length: take what is there.
  const std::size_t announced = load_be16(bytes, 2);
  const std::size_t total_bytes = announced == 0 ? bytes.size() : announced;
  if (header_bytes < kIpv4HeaderBytes || total_bytes < header_bytes) return ParseStatus::kMalformed;
  if (bytes.size() < total_bytes) return ParseStatus::kTruncated;

  const std::uint16_t fragment = load_be16(bytes, 6);
  packet.identification = load_be16(bytes, 4);
  packet.more_fragments = (fragment & 0x2000U) != 0;
  packet.fragment_offset = (fragment & 0x1FFFU) * 8U;
  packet.is_fragment = packet.more_fragments || packet.fragment_offset != 0;
  packet.protocol = bytes[9];
  packet.source = load_address(bytes, 12, false);
  packet.destination = load_address(bytes, 16, false);
  packet.payload = bytes.subspan(header_bytes, total_bytes - header_bytes);
  return ParseStatus::kOk;
}

/// Length of the IPv6 extension header that `rest` begins with; 0 if `type` is none that is
/// skipped.
std::size_t extension_bytes(std::uint8_t type, Bytes rest) {
  constexpr std::uint8_t kHopByHop = 0;
  constexpr std::uint8_t kRouting = 43;
  constexpr std::uint8_t kAuthentication = 51;
  constexpr std::uint8_t kDestinationOptions = 60;
  switch (type) {
    case kHopByHop:
    case kRouting:
    case kDestinationOptions:
      return (rest[1] + std::size_t{1}) * 8;
    case kAuthentication:
      return (rest[1] + std::size_t{2}) * 4;
    default:
      return 0;
  }
}

/// Walks the extension headers of an IPv6 packet up to the upper-layer header.
ParseStatus skip_extensions(IpPacket& packet) {
  constexpr std::uint8_t kFragment = 44;
  constexpr std::size_t kMinExtensionBytes = 8;
  while (packet.protocol != kProtocolUdp) {
    Bytes& rest = packet.payload;
    if (rest.size() < kMinExtensionBytes) return ParseStatus::kOk;  // Some other protocol.
    if (packet.protocol == kFragment) {
      const std::uint16_t fragment = load_be16(rest, 2);
      packet.fragment_offset = fragment & 0xFFF8U;
      packet.more_fragments = (fragment & 1U) != 0;
      packet.is_fragment = packet.more_fragments || packet.fragment_offset != 0;
      packet.identification = load_be32(rest, 4);
      packet.protocol = rest[0];
      rest = rest.subspan(kMinExtensionBytes);
      // Only the first fragment goes on with headers; what UDP data follows is the same either way.
      if (packet.fragment_offset != 0) return ParseStatus::kOk;
      continue;
    }
    const std::size_t length = extension_bytes(packet.protocol, rest);
    if (length == 0) return ParseStatus::kOk;
    if (length > rest.size()) return ParseStatus::kMalformed;
    packet.protocol = rest[0];
    rest = rest.subspan(length);
  }
  return ParseStatus::kOk;
}

ParseStatus parse_ipv6(Bytes bytes, IpPacket& packet) {
  if (bytes.size() < kIpv6HeaderBytes) return ParseStatus::kTruncated;
  const std::size_t announced = load_be16(bytes, 4);
  const std::size_t payload_bytes = announced == 0 ? bytes.size() - kIpv6HeaderBytes : announced;
  if (bytes.size() - kIpv6HeaderBytes < payload_bytes) return ParseStatus::kTruncated;
  packet.protocol = bytes[6];
  packet.source = load_address(bytes, 8, true);
  packet.destination = load_address(bytes, 24, true);
  packet.payload = bytes.subspan(kIpv6HeaderBytes, payload_bytes);
  return skip_extensions(packet);
}

}  // namespace

ParseStatus parse_ip(Bytes bytes, IpPacket& packet) {
  packet = {};
  if (bytes.empty()) return ParseStatus::kTruncated;
  switch (bytes[0] >> 4) {
    case 4:
      return parse_ipv4(bytes, packet);
    case 6:
      return parse_ipv6(bytes, packet);
    default:
      return ParseStatus::kOther;
  }
}

ParseStatus parse_udp(Bytes bytes, UdpDatagram& datagram) {
  if (bytes.size() < kUdpHeaderBytes) return ParseStatus::kMalformed;
  const std::size_t announced = load_be16(bytes, 4);
  const std::size_t length = announced == 0 ? bytes.size() : announced;
  if (length < kUdpHeaderBytes) return ParseStatus::kMalformed;
  if (length > bytes.size()) return ParseStatus::kTruncated;
  datagram.source_port = load_be16(bytes, 0);
  datagram.destination_port = load_be16(bytes, 2);
  datagram.payload = bytes.subspan(kUdpHeaderBytes, length - kUdpHeaderBytes);
  return ParseStatus::kOk;
}

}  // namespace glint
