// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace glint::daemon {

// Readers of the kernel's text files. What is malformed is passed over.

/// A counter of /proc/net/snmp, e.g. "Udp", "RcvbufErrors". Null when there is none.
std::optional<std::uint64_t> parse_snmp(std::string_view text, std::string_view protocol,
                                        std::string_view counter);

/// One UDP socket. Value type.
struct UdpSocketEntry {
  std::uint16_t local_port = 0;
  std::uint64_t inode = 0;
  std::uint64_t drops = 0;  ///< Datagrams for which its buffer had no room.
};

/// The sockets of /proc/net/udp or /proc/net/udp6.
std::vector<UdpSocketEntry> parse_udp_sockets(std::string_view text);

/// A file that holds one number, such as those of /proc/sys.
std::optional<std::int64_t> parse_number(std::string_view text);

}  // namespace glint::daemon
