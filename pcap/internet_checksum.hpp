// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>

#include "pcap/byte_order.hpp"
#include "pcap/endpoint.hpp"

namespace glint {

/// The Internet checksum (RFC 1071): the complement of the one's complement sum of 16-bit words.
/// Over data that includes a correct checksum it is 0.
std::uint16_t internet_checksum(Bytes data);

/// The same over a UDP datagram (header and payload) and its pseudo-header (RFC 768, RFC 8200).
std::uint16_t udp_checksum(const IpAddress& source, const IpAddress& destination, Bytes udp);

}  // namespace glint
