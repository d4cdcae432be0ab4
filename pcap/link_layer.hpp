// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <optional>

#include "pcap/byte_order.hpp"

namespace glint {

/// How a capture's records begin.
enum class LinkType { kEthernet, kRawIp, kLoopback, kLinuxCooked, kLinuxCooked2 };

/// Null for a libpcap link type (DLT_*) that carries no IP or is not known here.
std::optional<LinkType> link_type_of(int dlt);

enum class LinkStatus {
  kIp,         ///< What is left is an IP packet.
  kOther,      ///< Not IP: ARP, LLDP, ...
  kTruncated,  ///< The record ends within the link header.
};

/// Takes the link header, VLAN tags included (also stacked), off the front of `record`.
LinkStatus strip_link_header(LinkType type, Bytes& record);

}  // namespace glint
