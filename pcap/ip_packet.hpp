// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

#include "pcap/byte_order.hpp"
#include "pcap/endpoint.hpp"

namespace glint {

constexpr std::uint8_t kProtocolUdp = 17;
constexpr std::size_t kUdpHeaderBytes = 8;

/// One IP packet, its headers read. Non-owning: valid while the bytes parsed are.
struct IpPacket {
  IpAddress source;
  IpAddress destination;
  std::uint8_t protocol = 0;
  Bytes payload;  ///< What follows the IP headers; link-layer padding is cut off.

  bool is_fragment = false;
  std::uint32_t identification = 0;   ///< Of fragments only.
  std::uint32_t fragment_offset = 0;  ///< Bytes.
  bool more_fragments = false;
};

/// A UDP datagram's ports and payload. Non-owning.
struct UdpDatagram {
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  Bytes payload;
};

enum class ParseStatus {
  kOk,
  kOther,      ///< Neither IPv4 nor IPv6.
  kTruncated,  ///< Fewer bytes than the headers announce: a short snap length, or a cut.
  kMalformed,  ///< Headers that contradict themselves.
};

/// Reads the headers of an IPv4 or IPv6 packet, extension headers included. Checks every length.
ParseStatus parse_ip(Bytes bytes, IpPacket& packet);

/// Reads a whole (reassembled) UDP datagram. Checks every length; the checksum is not looked at,
/// because network cards that compute it leave it unset in captures of the sending machine.
ParseStatus parse_udp(Bytes bytes, UdpDatagram& datagram);

}  // namespace glint
