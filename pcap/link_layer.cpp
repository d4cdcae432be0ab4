// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "pcap/link_layer.hpp"

#include <pcap/dlt.h>

namespace glint {
namespace {

constexpr std::uint16_t kEtherTypeIpv4 = 0x0800;
constexpr std::uint16_t kEtherTypeIpv6 = 0x86DD;

/// 802.1Q, 802.1ad, and the older tag that stacked VLANs used before it.
bool is_vlan_tag(std::uint16_t ether_type) {
  return ether_type == 0x8100 || ether_type == 0x88A8 || ether_type == 0x9100;
}

/// Where a link header has its EtherType, and its length.
struct HeaderShape {
  std::size_t ether_type_at;
  std::size_t length;
};

LinkStatus strip_tagged_header(HeaderShape shape, Bytes& record) {
  constexpr std::size_t kTagBytes = 4;
  if (record.size() < shape.length) return LinkStatus::kTruncated;
  std::uint16_t ether_type = load_be16(record, shape.ether_type_at);
  record = record.subspan(shape.length);
  while (is_vlan_tag(ether_type)) {
    if (record.size() < kTagBytes) return LinkStatus::kTruncated;
    ether_type = load_be16(record, 2);
    record = record.subspan(kTagBytes);
  }
  const bool is_ip = ether_type == kEtherTypeIpv4 || ether_type == kEtherTypeIpv6;
  return is_ip ? LinkStatus::kIp : LinkStatus::kOther;
}

LinkStatus strip_fixed_header(std::size_t length, Bytes& record) {
  if (record.size() < length) return LinkStatus::kTruncated;
  record = record.subspan(length);
  return LinkStatus::kIp;
}

}  // namespace

std::optional<LinkType> link_type_of(int dlt) {
  switch (dlt) {
    case DLT_EN10MB:
      return LinkType::kEthernet;
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_IPV6:
      return LinkType::kRawIp;
    case DLT_NULL:
    case DLT_LOOP:
      return LinkType::kLoopback;
    case DLT_LINUX_SLL:
      return LinkType::kLinuxCooked;
    case DLT_LINUX_SLL2:
      return LinkType::kLinuxCooked2;
    default:
      return std::nullopt;
  }
}

LinkStatus strip_link_header(LinkType type, Bytes& record) {
  switch (type) {
    case LinkType::kEthernet:
      return strip_tagged_header({12, 14}, record);
    case LinkType::kLinuxCooked:
      return strip_tagged_header({14, 16}, record);
    case LinkType::kLinuxCooked2:
      return strip_tagged_header({0, 20}, record);
    case LinkType::kLoopback:
      // Four bytes of address family, in the byte order and numbering of the machine that captured;
      // the version in the IP header says the same without guessing.
      return strip_fixed_header(4, record);
    case LinkType::kRawIp:
      return strip_fixed_header(0, record);
  }
  return LinkStatus::kOther;
}

}  // namespace glint
