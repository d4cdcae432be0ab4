// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

namespace glint {

/// An IPv4 or IPv6 address. Value type; unused bytes are zero, so comparison is bytewise.
struct IpAddress {
  bool is_v6 = false;
  std::array<std::uint8_t, 16> bytes{};  ///< Network order; the first 4 for IPv4.

  /// Reads dotted IPv4 or colon IPv6 text (no host names, no zones). Null for anything else.
  static std::optional<IpAddress> parse(std::string_view text);
  static constexpr IpAddress v4(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
    return {false, {a, b, c, d}};
  }

  friend bool operator==(const IpAddress&, const IpAddress&) = default;
  friend bool operator<(const IpAddress& a, const IpAddress& b) {
    return std::tie(a.is_v6, a.bytes) < std::tie(b.is_v6, b.bytes);
  }
};

/// An address and a UDP port.
struct Endpoint {
  IpAddress address;
  std::uint16_t port = 0;

  friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

/// "192.0.2.1", "2001:db8::1".
std::string to_string(const IpAddress& address);
/// "192.0.2.1:7502", "[2001:db8::1]:7502".
std::string to_string(const Endpoint& endpoint);

}  // namespace glint
