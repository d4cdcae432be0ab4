// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/internet_checksum.hpp"

#include "pcap/ip_packet.hpp"

namespace glint {
namespace {

std::uint64_t word_sum(Bytes data) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i + 1 < data.size(); i += 2) sum += load_be16(data, i);
  if (data.size() % 2 == 1) sum += std::uint64_t{data.back()} << 8;
  return sum;
}

std::uint16_t fold(std::uint64_t sum) {
  while (sum >> 16 != 0) sum = (sum & 0xFFFF) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum & 0xFFFF);
}

}  // namespace

std::uint16_t internet_checksum(Bytes data) { return fold(word_sum(data)); }

std::uint16_t udp_checksum(const IpAddress& source, const IpAddress& destination, Bytes udp) {
  // The unused bytes of IPv4 addresses are zero and do not change the sum.
  return fold(word_sum(source.bytes) + word_sum(destination.bytes) + kProtocolUdp + udp.size() +
              word_sum(udp));
}

}  // namespace glint
